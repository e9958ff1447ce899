#include "reports/figures/series_styles.hpp"

#include <set>
#include <string>

namespace corridor::figures {

SeriesStyles::SeriesStyles(const reports::Cases& cases) {
  std::set<std::string> seen;
  std::size_t num_spares_used = 0;
  for (const reports::Series& series : cases.series()) {
    const SeriesStyle* own = system_style(series.system);
    const bool is_first = seen.insert(series.system).second;
    styles_[series] = own != nullptr && is_first ? own : &spare_style(num_spares_used++);
  }
}

}  // namespace corridor::figures
