// Whether the angles of a file look like degrees. Internal to this folder.
#pragma once

#include <fmt/format.h>

#include <cmath>
#include <cstddef>
#include <numbers>
#include <optional>
#include <string>

namespace corridor::formats {

// Whole turns are written by some, rounded; more is degrees for radians, or was not wrapped.
inline constexpr double kWholeTurn_rad = 2 * std::numbers::pi + 1e-3;

class DegreeCheck {
 public:
  void take(double angle_rad) {
    ++num_angles_;
    if (std::abs(angle_rad) > kWholeTurn_rad) ++num_beyond_;
  }

  // What to note where many angles are beyond a turn; headings that count whole turns are, too.
  [[nodiscard]] std::optional<std::string> note() const {
    if (num_beyond_ < kLeastBeyond ||
        static_cast<double>(num_beyond_) <= kMany_ratio * static_cast<double>(num_angles_)) {
      return std::nullopt;
    }
    return fmt::format("{} of {} angles are beyond 2 pi: degrees for radians?", num_beyond_,
                       num_angles_);
  }

 private:
  // Of headings in degrees all but a thirtieth are, of the turns from one pose to the next at least
  // those at corners; a file in radians has at most a few that were not wrapped.
  static constexpr double kMany_ratio = 0.1;
  static constexpr std::size_t kLeastBeyond = 5;

  std::size_t num_angles_ = 0;
  std::size_t num_beyond_ = 0;
};

}  // namespace corridor::formats
