#include <fmt/format.h>

#include <Eigen/Eigenvalues>
#include <cmath>
#include <numbers>
#include <unordered_map>
#include <utility>

#include "datasets/formats/degree_check.hpp"
#include "datasets/formats/file_bytes.hpp"
#include "datasets/formats/graphs/pose_graph_file.hpp"
#include "datasets/formats/graphs/pose_graph_vocabulary.hpp"
#include "datasets/formats/text.hpp"

namespace corridor::formats {
namespace {

constexpr std::size_t kNumVertexFields = 5;
constexpr std::size_t kNumEdgeFields = 12;
// Files print six digits; an eigenvalue this far below zero, as a share of the largest, is no
// rounding of theirs.
constexpr double kNegativeRatio = 1e-6;
// Eigenvalues below this share of the largest do not weigh in a factor (square_root_information).
constexpr double kSingularRatio = 1e-15;

class PoseGraphParser {
 public:
  PoseGraphParser(GraphFormat format, const std::string& file)
      : format_(format), words_(vocabulary_of(format)), file_(file) {}

  Result<void> take(std::string_view line, std::size_t line_number) {
    line_number_ = line_number;
    const auto fields = split_fields(line);
    if (fields.empty() || fields.front().front() == '#') return {};
    if (fields.front() == words_.vertex_tag) return take_vertex(fields);
    if (fields.front() == words_.edge_tag) return take_edge(fields);
    if (!words_.fix_tag.empty() && fields.front() == words_.fix_tag) return take_fix(fields);
    return failure(ErrorCode::kUnsupported, "line of kind " + quote(fields.front()),
                   fmt::format("{}{}{}{} of a {} graph", words_.vertex_tag,
                               words_.fix_tag.empty() ? " or " : ", ", words_.edge_tag,
                               words_.fix_tag.empty() ? "" : " or FIX", to_text(format_)));
  }

  Result<PoseGraph> finish() {
    if (graph_.vertices.empty()) {
      return fail(ErrorCode::kMalformed, "the graph has no vertex", file_,
                  fmt::format("lines {}", words_.vertex_layout));
    }
    for (std::size_t i = 0; i < graph_.edges.size(); ++i) {
      for (const std::uint32_t id : {graph_.edges[i].i, graph_.edges[i].j}) {
        if (auto found = expect_vertex(id, edge_lines_[i]); !found) {
          return tl::make_unexpected(found.error());
        }
      }
    }
    for (std::size_t i = 0; i < graph_.fixed.size(); ++i) {
      if (auto found = expect_vertex(graph_.fixed[i], fix_lines_[i]); !found) {
        return tl::make_unexpected(found.error());
      }
    }
    count_oddities();
    return std::move(graph_);
  }

 private:
  [[nodiscard]] std::string where(std::size_t line_number) const {
    return fmt::format("{}:{}", file_, line_number);
  }
  [[nodiscard]] tl::unexpected<Error> failure(ErrorCode code, std::string what,
                                              std::string expected) const {
    return fail(code, std::move(what), where(line_number_), std::move(expected));
  }

  Result<void> expect_fields(std::size_t found, std::size_t expected,
                             std::string_view layout) const {
    if (found == expected) return {};
    return failure(ErrorCode::kMalformed, fmt::format("{} fields", found),
                   fmt::format("{}: {}", expected, layout));
  }

  [[nodiscard]] Result<std::uint32_t> id_of(std::string_view field) const {
    const auto id = parse_integer(field);
    if (!id || *id < 0 || *id > static_cast<std::int64_t>(kMaxPoseId)) {
      return failure(ErrorCode::kMalformed, "id " + quote(field),
                     fmt::format("a whole number from 0 to {}", kMaxPoseId));
    }
    return static_cast<std::uint32_t>(*id);
  }

  [[nodiscard]] Result<double> number_of(std::string_view field) const {
    const auto number = parse_double(field);
    if (!number || !std::isfinite(*number)) {
      return failure(ErrorCode::kMalformed, "field " + quote(field), "a finite number");
    }
    return *number;
  }

  // Three fields "x y theta" from `first` on.
  Result<Pose2> pose_of(const std::vector<std::string_view>& fields, std::size_t first) {
    std::array<double, 3> numbers{};
    for (std::size_t i = 0; i < numbers.size(); ++i) {
      const auto number = number_of(fields[first + i]);
      if (!number) return tl::make_unexpected(number.error());
      numbers[i] = *number;
    }
    if (std::abs(numbers[2]) > std::numbers::pi) ++num_wrapped_;
    degrees_.take(numbers[2]);
    return Pose2(numbers[0], numbers[1], numbers[2]);
  }

  Result<void> take_vertex(const std::vector<std::string_view>& fields) {
    if (auto good = expect_fields(fields.size(), kNumVertexFields, words_.vertex_layout); !good) {
      return good;
    }
    const auto id = id_of(fields[1]);
    if (!id) return tl::make_unexpected(id.error());
    const auto T_map_base = pose_of(fields, 2);
    if (!T_map_base) return tl::make_unexpected(T_map_base.error());
    const auto [known, is_new] = vertex_lines_.emplace(*id, line_number_);
    if (!is_new) {
      return failure(ErrorCode::kInvalid,
                     fmt::format("vertex {} stands in line {} already", *id, known->second),
                     "each vertex once");
    }
    graph_.vertices.push_back({*id, *T_map_base});
    return {};
  }

  Result<void> take_edge(const std::vector<std::string_view>& fields) {
    if (auto good = expect_fields(fields.size(), kNumEdgeFields, words_.edge_layout); !good) {
      return good;
    }
    const auto i = id_of(fields[1]);
    if (!i) return tl::make_unexpected(i.error());
    const auto j = id_of(fields[2]);
    if (!j) return tl::make_unexpected(j.error());
    if (*i == *j) {
      return failure(ErrorCode::kInvalid, fmt::format("edge from pose {} to itself", *i),
                     "two poses");
    }
    const auto T_i_j = pose_of(fields, 3);
    if (!T_i_j) return tl::make_unexpected(T_i_j.error());
    PoseGraph::Edge edge{*i, *j, *T_i_j, {}};
    for (std::size_t cell = 0; cell < words_.information.size(); ++cell) {
      const auto number = number_of(fields[6 + cell]);
      if (!number) return tl::make_unexpected(number.error());
      const auto [row, column] = words_.information[cell];
      edge.information(row, column) = edge.information(column, row) = *number;
    }
    if (auto good = check_information(edge.information); !good) return good;
    graph_.edges.push_back(edge);
    edge_lines_.push_back(line_number_);
    return {};
  }

  Result<void> check_information(const Eigen::Matrix3d& information) {
    const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(information,
                                                                Eigen::EigenvaluesOnly);
    const double smallest = solver.eigenvalues().minCoeff();
    const double largest = solver.eigenvalues().maxCoeff();
    // Negated, so that eigenvalues that overflowed fail too.
    if (!(std::isfinite(largest) && smallest >= -kNegativeRatio * largest)) {
      return failure(ErrorCode::kInvalid,
                     fmt::format("information with the eigenvalue {:.6g}", smallest),
                     fmt::format("a positive semi-definite matrix: {}", words_.edge_layout));
    }
    if (!(smallest > kSingularRatio * largest)) ++num_singular_;
    return {};
  }

  Result<void> take_fix(const std::vector<std::string_view>& fields) {
    if (fields.size() < 2) {
      return failure(ErrorCode::kMalformed, "FIX of no pose", "'FIX id ..'");
    }
    for (std::size_t i = 1; i < fields.size(); ++i) {
      const auto id = id_of(fields[i]);
      if (!id) return tl::make_unexpected(id.error());
      const auto [known, is_new] = fixed_lines_of_.emplace(*id, line_number_);
      if (!is_new) {
        return failure(ErrorCode::kInvalid,
                       fmt::format("pose {} is fixed in line {} already", *id, known->second),
                       "each pose once");
      }
      graph_.fixed.push_back(*id);
      fix_lines_.push_back(line_number_);
    }
    return {};
  }

  [[nodiscard]] Result<void> expect_vertex(std::uint32_t id, std::size_t line_number) const {
    if (vertex_lines_.contains(id)) return {};
    return fail(ErrorCode::kInvalid, fmt::format("pose {} has no vertex", id), where(line_number),
                fmt::format("a line {}", words_.vertex_layout));
  }

  void count_oddities() {
    const auto note = [this](std::size_t count, std::string_view what) {
      if (count > 0) graph_.notes.push_back(fmt::format("{} {}", count, what));
    };
    note(num_repeated_pairs(graph_), "edges repeat a pair of poses; all are kept");
    note(num_singular_, "edges with singular information leave directions free");
    note(num_wrapped_, "angles wrapped to (-pi, pi]");
    if (auto degrees = degrees_.note()) graph_.notes.push_back(std::move(*degrees));
    const std::size_t parts = num_parts(graph_);
    note(parts > 1 ? parts : 0, "parts that no edge joins");
  }

  GraphFormat format_;
  const GraphVocabulary& words_;
  const std::string& file_;
  std::size_t line_number_ = 0;
  PoseGraph graph_;
  // Where each stands, for messages.
  std::unordered_map<std::uint32_t, std::size_t> vertex_lines_;
  std::unordered_map<std::uint32_t, std::size_t> fixed_lines_of_;
  std::vector<std::size_t> edge_lines_;
  std::vector<std::size_t> fix_lines_;
  std::size_t num_wrapped_ = 0;
  std::size_t num_singular_ = 0;
  DegreeCheck degrees_;
};

}  // namespace

Result<PoseGraph> parse_pose_graph(std::string_view text, GraphFormat format,
                                   const std::string& name) {
  const auto note = note_on_end(text);
  PoseGraphParser parser(format, name);
  std::size_t line_number = 0;
  while (const auto line = take_line(text)) {
    if (auto taken = parser.take(*line, ++line_number); !taken) {
      return tl::make_unexpected(taken.error());
    }
  }
  auto graph = parser.finish();
  if (graph && note) graph->notes.push_back(*note);
  return graph;
}

Result<PoseGraph> read_pose_graph(const std::filesystem::path& path) {
  const auto format = graph_format_from_suffix(path);
  if (!format) {
    return fail(ErrorCode::kUnsupported, "unknown kind of graph", path.string(),
                "a name that ends in .g2o, .graph or .toro");
  }
  const auto bytes = read_file_bytes(path);
  if (!bytes) return tl::make_unexpected(bytes.error());
  return parse_pose_graph(*bytes, *format, path.string());
}

}  // namespace corridor::formats
