#include "slam/backend/robust/maximum_clique.hpp"

#include <algorithm>
#include <bit>
#include <numeric>

namespace corridor::backend {
namespace {

using Bits = std::vector<std::uint64_t>;
constexpr std::size_t kNone = static_cast<std::size_t>(-1);

std::size_t first_of(const Bits& bits) {
  for (std::size_t w = 0; w < bits.size(); ++w) {
    if (bits[w] != 0) {
      return w * BitGraph::kWordBits + static_cast<std::size_t>(std::countr_zero(bits[w]));
    }
  }
  return kNone;
}

void erase(Bits& bits, std::size_t node) {
  bits[node / BitGraph::kWordBits] &= ~(std::uint64_t{1} << (node % BitGraph::kWordBits));
}

std::size_t count(const std::uint64_t* words, std::size_t num_words) {
  return std::accumulate(words, words + num_words, std::size_t{0}, [](std::size_t sum, auto word) {
    return sum + static_cast<std::size_t>(std::popcount(word));
  });
}

// The nodes from the highest degree down, so that the lowest bit is the best joined one.
std::vector<std::size_t> by_degree(const BitGraph& graph) {
  std::vector<std::size_t> degrees, nodes(graph.num_nodes());
  for (std::size_t i = 0; i < graph.num_nodes(); ++i) {
    degrees.push_back(count(graph.row(i), graph.num_words()));
  }
  std::iota(nodes.begin(), nodes.end(), std::size_t{0});
  std::stable_sort(nodes.begin(), nodes.end(),
                   [&](std::size_t a, std::size_t b) { return degrees[a] > degrees[b]; });
  return nodes;
}

BitGraph renumbered(const BitGraph& graph, const std::vector<std::size_t>& nodes) {
  BitGraph renamed(nodes.size());
  for (std::size_t a = 0; a < nodes.size(); ++a) {
    for (std::size_t b = 0; b < a; ++b) {
      if (graph.are_joined(nodes[a], nodes[b])) renamed.join(a, b);
    }
  }
  return renamed;
}

class Search {
 public:
  Search(const BitGraph& graph, std::int64_t max_branches)
      : graph_(graph), branches_left_(max_branches) {}

  Clique run() {
    for (std::size_t node = 0; node < graph_.num_nodes(); ++node) grow_greedily(node);
    Bits all(graph_.num_words(), 0);
    for (std::size_t node = 0; node < graph_.num_nodes(); ++node) {
      all[node / BitGraph::kWordBits] |= std::uint64_t{1} << (node % BitGraph::kWordBits);
    }
    expand(std::move(all));
    return {best_, branches_left_ > 0};
  }

 private:
  Bits neighbours_among(const Bits& candidates, std::size_t node) const {
    Bits left(candidates.size());
    std::transform(candidates.begin(), candidates.end(), graph_.row(node), left.begin(),
                   [](std::uint64_t a, std::uint64_t b) { return a & b; });
    return left;
  }

  void grow_greedily(std::size_t start) {
    std::vector<std::size_t> clique{start};
    Bits candidates(graph_.row(start), graph_.row(start) + graph_.num_words());
    if (count(candidates.data(), candidates.size()) < best_.size()) return;
    for (std::size_t node = first_of(candidates); node != kNone; node = first_of(candidates)) {
      clique.push_back(node);
      candidates = neighbours_among(candidates, node);
    }
    if (clique.size() > best_.size()) best_ = std::move(clique);
  }

  struct Coloured {
    std::size_t node;
    std::size_t colour;  // from 1; no clique of the nodes so far is larger
  };

  // Nodes of one colour are joined to none of their own: one of them at most is in a clique. Those
  // whose colour rules out a larger clique than the best are left out.
  std::vector<Coloured> colour(Bits left) const {
    std::vector<Coloured> order;
    for (std::size_t colour = 1; first_of(left) != kNone; ++colour) {
      Bits free = left;
      for (std::size_t node = first_of(free); node != kNone; node = first_of(free)) {
        erase(left, node);
        erase(free, node);
        for (std::size_t w = 0; w < free.size(); ++w) free[w] &= ~graph_.row(node)[w];
        if (chosen_.size() + colour > best_.size()) order.push_back({node, colour});
      }
    }
    return order;
  }

  // Extends chosen_ by the candidates, which are joined to all of it. Its depth is the size of a
  // clique.
  void expand(Bits candidates) {
    const std::vector<Coloured> order = colour(candidates);
    for (auto last = order.rbegin(); last != order.rend(); ++last) {
      if (chosen_.size() + last->colour <= best_.size()) return;
      if (--branches_left_ <= 0) return;
      chosen_.push_back(last->node);
      Bits next = neighbours_among(candidates, last->node);
      if (first_of(next) != kNone) {
        expand(std::move(next));
      } else if (chosen_.size() > best_.size()) {
        best_ = chosen_;
      }
      chosen_.pop_back();
      erase(candidates, last->node);
    }
  }

  const BitGraph& graph_;
  std::int64_t branches_left_;
  std::vector<std::size_t> chosen_, best_;
};

}  // namespace

Clique maximum_clique(const BitGraph& graph, std::int64_t max_branches) {
  const std::vector<std::size_t> nodes = by_degree(graph);
  Clique clique = Search(renumbered(graph, nodes), max_branches).run();
  for (std::size_t& node : clique.nodes) node = nodes[node];
  std::sort(clique.nodes.begin(), clique.nodes.end());
  return clique;
}

}  // namespace corridor::backend
