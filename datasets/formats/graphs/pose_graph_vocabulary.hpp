// The words and the order of numbers of each graph format, shared by reader and writer. Internal to
// this folder.
#pragma once

#include <array>
#include <string_view>

#include "datasets/formats/graphs/pose_graph_file.hpp"

namespace corridor::formats {

struct GraphVocabulary {
  struct Cell {
    int row;
    int column;
  };

  std::string_view vertex_tag;
  std::string_view edge_tag;
  std::string_view fix_tag;  // empty: the format has none
  std::string_view vertex_layout;
  std::string_view edge_layout;
  // Where the six numbers of an edge's information belong, order (x_m, y_m, theta_rad).
  std::array<Cell, 6> information;
};

inline constexpr GraphVocabulary kG2oVocabulary{
    "VERTEX_SE2",
    "EDGE_SE2",
    "FIX",
    "'VERTEX_SE2 id x y theta'",
    "'EDGE_SE2 i j dx dy dtheta Ixx Ixy Ixt Iyy Iyt Itt'",
    {{{0, 0}, {0, 1}, {0, 2}, {1, 1}, {1, 2}, {2, 2}}}};

inline constexpr GraphVocabulary kToroVocabulary{
    "VERTEX2",
    "EDGE2",
    "",
    "'VERTEX2 id x y theta'",
    "'EDGE2 i j dx dy dtheta Ixx Ixy Iyy Itt Ixt Iyt'",
    {{{0, 0}, {0, 1}, {1, 1}, {2, 2}, {0, 2}, {1, 2}}}};

constexpr const GraphVocabulary& vocabulary_of(GraphFormat format) {
  return format == GraphFormat::kG2o ? kG2oVocabulary : kToroVocabulary;
}

}  // namespace corridor::formats
