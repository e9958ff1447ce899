// Figures that others published, shown beside ours. Never an input of any computation.
#pragma once

#include <array>
#include <optional>
#include <string_view>

#include "reports/metrics.hpp"

namespace corridor::reports {

// [DoDuc2024] "Fusion LiDAR-Inertial-Encoder data for High-Accuracy SLAM", table 1 (lengths in m,
// angle in deg; GMapping's are not given there).
struct PublishedKeyValue {
  KeyVariable variable;
  double true_value;
  double karto;
  double proposed;
};
inline constexpr std::array kPaperTable1 = {
    PublishedKeyValue{KeyVariable::kA, 14.500, 13.415, 13.897},
    PublishedKeyValue{KeyVariable::kB, 21.000, 19.600, 20.226},
    PublishedKeyValue{KeyVariable::kC, 5.000, 4.863, 4.908},
    PublishedKeyValue{KeyVariable::kAlpha, 90.00, 92.286, 89.236}};

// [DoDuc2024] table 2, under our names of the systems.
struct PublishedError {
  std::string_view system;
  double position_m;
  double angle_deg;
};
inline constexpr std::array kPaperTable2 = {PublishedError{"gmapping", 4.5489, 1.357},
                                            PublishedError{"karto", 0.6032, 0.923},
                                            PublishedError{"fusion-paper", 0.1949, 0.674}};

// [Kuemmerle2009] absolute translation error of relations, mean and standard deviation.
struct PublishedRelations {
  std::string_view dataset;
  std::string_view method;
  double translation_mean_m;
  double translation_std_m;
};
inline constexpr std::array kPublishedRelations = {
    PublishedRelations{"intel", "scan matching", 0.220, 0.296},
    PublishedRelations{"intel", "RBPF, 50 particles", 0.070, 0.083},
    PublishedRelations{"intel", "graph mapping", 0.031, 0.026},
    PublishedRelations{"fr079", "scan matching", 0.258, 0.427},
    PublishedRelations{"fr079", "RBPF, 50 particles", 0.061, 0.044},
    PublishedRelations{"fr079", "graph mapping", 0.056, 0.042}};

}  // namespace corridor::reports
