// Which style each series of a report has, the same in every figure: the first series of a system
// has the system's own style, further ones (other profiles, back-ends, parameters, revisions) and
// unknown systems get spares in turn.
#pragma once

#include <map>

#include "reports/cases.hpp"
#include "reports/figures/style.hpp"

namespace corridor::figures {

class SeriesStyles {
 public:
  explicit SeriesStyles(const reports::Cases& cases);
  // Requires a series of the cases.
  [[nodiscard]] const SeriesStyle& operator()(const reports::Series& series) const {
    return *styles_.at(series);
  }

 private:
  std::map<reports::Series, const SeriesStyle*> styles_;
};

}  // namespace corridor::figures
