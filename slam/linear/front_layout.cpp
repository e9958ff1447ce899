#include "slam/linear/front_layout.hpp"

#include <algorithm>
#include <numeric>

#include "slam/linear/front_kernels.hpp"

namespace corridor::linear {
namespace {

// A block of the matrix by places in the order of elimination.
struct PlacedBlock {
  int high = 0;            // its other place, the higher one
  BlockCopy copy;          // without what the panels decide
  bool is_turned = false;  // its rows come before its columns in the order of elimination
};

// Blocks by their lower place: those of place k are blocks[starts[k]] ... blocks[starts[k + 1]-1].
struct PlacedBlocks {
  std::vector<int> starts;
  std::vector<PlacedBlock> blocks;
};

// Calls visit(row variable, column variable, block) for every block of the matrix.
template <class Visit>
void for_each_block(const BlockMatrix& matrix, const Visit& visit) {
  const BlockMatrix::Scalars scalars = matrix.scalars();
  const std::vector<int>& starts = matrix.starts();
  const auto dimension = [&](int v) { return starts[to_index(v) + 1] - starts[to_index(v)]; };
  for (int j = 0; j < matrix.num_variables(); ++j) {
    const int* column = scalars.outerIndexPtr() + starts[to_index(j)];
    BlockCopy copy;
    copy.from_stride = column[1] - column[0];
    copy.num_columns = dimension(j);
    copy.from = column[0];
    const auto visit_row = [&](int i) {
      copy.num_rows = dimension(i);
      visit(i, j, copy);
      copy.from += copy.num_rows;
    };
    visit_row(j);
    for (const int i : matrix.pattern().of(j)) visit_row(i);
  }
}

PlacedBlocks place_blocks(const BlockMatrix& matrix, const std::vector<int>& place) {
  PlacedBlocks placed;
  placed.starts.assign(place.size() + 1, 0);
  placed.blocks.resize(place.size() + matrix.pattern().rows.size());
  const auto lower_place = [&](int i, int j) {
    return to_index(std::min(place[to_index(i)], place[to_index(j)]));
  };
  for_each_block(matrix,
                 [&](int i, int j, const BlockCopy&) { ++placed.starts[lower_place(i, j) + 1]; });
  std::partial_sum(placed.starts.begin(), placed.starts.end(), placed.starts.begin());
  std::vector<int> next(placed.starts.begin(), placed.starts.end() - 1);
  for_each_block(matrix, [&](int i, int j, const BlockCopy& copy) {
    const int row = place[to_index(i)], column = place[to_index(j)];
    placed.blocks[to_index(next[lower_place(i, j)]++)] = {std::max(row, column), copy,
                                                          row < column};
  });
  return placed;
}

// Appends rows that follow the last ones here: to the run before, of those from `first` on, if
// they follow it there too.
void append_run(std::vector<RowRun>& runs, std::size_t first, const RowRun& run) {
  if (runs.size() > first && runs.back().to + runs.back().length == run.to) {
    runs.back().length += run.length;
  } else {
    runs.push_back(run);
  }
}

class LayoutBuilder {
 public:
  LayoutBuilder(const BlockMatrix& matrix, const std::vector<int>& order) : matrix_(matrix) {
    std::vector<int> dimensions;
    const std::vector<int>& starts = matrix.starts();
    for (std::size_t j = 1; j < starts.size(); ++j) dimensions.push_back(starts[j] - starts[j - 1]);
    out_.plan = EliminationPlanner().plan(matrix.pattern(), order, dimensions);
    for (const int variable : out_.plan.order) {
      for (int row = starts[to_index(variable)]; row < starts[to_index(variable) + 1]; ++row) {
        out_.row_order.push_back(row);
      }
      first_scalars_.push_back(static_cast<int>(out_.row_order.size()));
    }
    front_row_.resize(dimensions.size());
    out_.fronts.resize(out_.plan.supernodes.size());
  }

  FrontLayout build() {
    for (std::size_t s = 0; s < out_.fronts.size(); ++s) measure(s);
    for (std::size_t s = 0; s < out_.fronts.size(); ++s) list_runs(s);
    list_copies();
    list_joins();
    find_stack_size();
    return std::move(out_);
  }

 private:
  [[nodiscard]] int dimension(int place) const {
    return first_scalars_[to_index(place) + 1] - first_scalars_[to_index(place)];
  }

  void measure(std::size_t s) {
    const Supernode& node = out_.plan.supernodes[s];
    Front& front = out_.fronts[s];
    front.first_pivot = first_scalars_[to_index(node.first_place)];
    front.num_pivots = first_scalars_[to_index(node.end_place)] - front.first_pivot;
    front.num_rows = front.num_pivots;
    for (const int place : out_.plan.rows_of(node)) front.num_rows += dimension(place);
    front.stride = front_stride(front.num_rows);
    front.panel = out_.panels_size;
    front.has_parent = node.parent >= 0;
    if (front.has_parent) ++out_.fronts[to_index(node.parent)].num_children;
    out_.panels_size += front.panel_size();
    out_.max_rows = std::max(out_.max_rows, front.num_rows);
    const double p = front.num_pivots, r = front.num_below();
    out_.num_nonzeros += p * (p + 1) / 2 + p * r;
    out_.num_flops += p * p * p / 3 + p * p * r + p * r * r;
  }

  void list_runs(std::size_t s) {
    Front& front = out_.fronts[s];
    front.first_run = out_.runs.size();
    int row = front.num_pivots;
    for (const int place : out_.plan.rows_of(out_.plan.supernodes[s])) {
      append_run(out_.runs, front.first_run,
                 {row, first_scalars_[to_index(place)], dimension(place)});
      row += dimension(place);
    }
    front.end_run = out_.runs.size();
  }

  // Fills front_row_ for every place that the front has.
  void find_rows(std::size_t s) {
    const Supernode& node = out_.plan.supernodes[s];
    int row = 0;
    const auto put = [&](int place) {
      front_row_[to_index(place)] = row;
      row += dimension(place);
    };
    for (int place = node.first_place; place < node.end_place; ++place) put(place);
    for (const int place : out_.plan.rows_of(node)) put(place);
  }

  void list_copies() {
    const PlacedBlocks placed = place_blocks(matrix_, out_.plan.place);
    out_.copies.reserve(placed.blocks.size());
    for (std::size_t s = 0; s < out_.fronts.size(); ++s) {
      find_rows(s);
      const Supernode& node = out_.plan.supernodes[s];
      Front& front = out_.fronts[s];
      front.first_copy = out_.copies.size();
      for (int place = node.first_place; place < node.end_place; ++place) {
        for (int b = placed.starts[to_index(place)]; b < placed.starts[to_index(place) + 1]; ++b) {
          append_copy(placed.blocks[to_index(b)], front, place);
        }
      }
      front.end_copy = out_.copies.size();
    }
  }

  void append_copy(const PlacedBlock& block, const Front& front, int low) {
    BlockCopy copy = block.copy;
    copy.to =
        front.panel + front_row_[to_index(low)] * front.stride + front_row_[to_index(block.high)];
    const int stride = static_cast<int>(front.stride);
    copy.row_step = block.is_turned ? stride : 1;
    copy.column_step = block.is_turned ? 1 : stride;
    out_.copies.push_back(copy);
  }

  void list_joins() {
    std::vector<std::vector<std::size_t>> children(out_.fronts.size());
    for (std::size_t s = 0; s < out_.fronts.size(); ++s) {
      if (out_.fronts[s].has_parent) {
        children[to_index(out_.plan.supernodes[s].parent)].push_back(s);
      }
    }
    for (std::size_t s = 0; s < out_.fronts.size(); ++s) {
      if (children[s].empty()) continue;
      find_rows(s);
      for (const std::size_t child : children[s]) list_joins_of(child);
    }
  }

  // Requires find_rows() of its parent.
  void list_joins_of(std::size_t s) {
    Front& front = out_.fronts[s];
    front.first_join = out_.joins.size();
    int row = 0;
    for (const int place : out_.plan.rows_of(out_.plan.supernodes[s])) {
      append_run(out_.joins, front.first_join,
                 {row, front_row_[to_index(place)], dimension(place)});
      row += dimension(place);
    }
    front.end_join = out_.joins.size();
  }

  // A front's update is made above those of its children, which then are used up.
  void find_stack_size() {
    std::vector<std::ptrdiff_t> of_children(out_.fronts.size(), 0);
    std::ptrdiff_t stack = 0;
    for (std::size_t s = 0; s < out_.fronts.size(); ++s) {
      const std::ptrdiff_t update = out_.fronts[s].update_size();
      out_.stack_size = std::max(out_.stack_size, stack + update);
      stack += update - of_children[s];
      if (out_.fronts[s].has_parent) {
        of_children[to_index(out_.plan.supernodes[s].parent)] += update;
      }
    }
  }

  const BlockMatrix& matrix_;
  FrontLayout out_;
  std::vector<int> first_scalars_ = {0};  // of every place in the order of elimination, and the end
  std::vector<int> front_row_;            // of every place, in the front that is looked at
};

}  // namespace

std::ptrdiff_t Front::update_stride() const { return front_stride(num_below()); }

FrontLayout lay_out_fronts(const BlockMatrix& matrix, const std::vector<int>& order) {
  return LayoutBuilder(matrix, order).build();
}

}  // namespace corridor::linear
