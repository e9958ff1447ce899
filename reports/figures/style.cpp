#include "reports/figures/style.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstddef>

namespace corridor::figures {
namespace {

constexpr double kLabelGap_px = 24;
constexpr double kMinLabelColumn_px = 150;
constexpr double kMaxLabelColumn_px = 330;

constexpr SeriesStyle kTruth{"truth", "#111111", "#f2f2f2", "", Marker::kCircle};

struct NamedStyle {
  std::string_view system;
  SeriesStyle style;
};

constexpr std::array kSystems = {
    NamedStyle{"dead-reckoning", {"dead-reckoning", "#777777", "#a3a3a3", "2 4", Marker::kDiamond}},
    NamedStyle{"dead-reckoning-gyro",
               {"dead-reckoning-gyro", "#8a6d3b", "#c9a66b", "2 2", Marker::kDiamond}},
    NamedStyle{"gmapping", {"gmapping", "#D55E00", "#ff8a3d", "9 3", Marker::kTriangle}},
    NamedStyle{"karto", {"karto", "#0072B2", "#5aaee6", "6 3", Marker::kSquare}},
    NamedStyle{"mrpt-icp", {"mrpt-icp", "#E69F00", "#f2b632", "8 3 2 3", Marker::kSquare}},
    NamedStyle{"mrpt-rbpf", {"mrpt-rbpf", "#6a51a3", "#ab98e0", "8 3 2 3 2 3", Marker::kTriangle}},
    NamedStyle{"fusion-paper", {"fusion-paper", "#CC79A7", "#e79cc6", "4 2", Marker::kCircle}},
    NamedStyle{"fusion", {"fusion", "#009E73", "#2ccf9f", "", Marker::kCircle}},
};

constexpr std::array kSpares = {
    SeriesStyle{"spare-0", "#882255", "#d977a8", "5 2 1 2", Marker::kDiamond},
    SeriesStyle{"spare-1", "#117733", "#5cbd7c", "5 2 1 2 1 2", Marker::kSquare},
    SeriesStyle{"spare-2", "#332288", "#9487e0", "3 1", Marker::kTriangle},
    SeriesStyle{"spare-3", "#999933", "#cfcf62", "7 2", Marker::kCircle},
    SeriesStyle{"spare-4", "#44AA99", "#63cdbb", "10 2 2 2", Marker::kDiamond},
    SeriesStyle{"spare-5", "#CC6677", "#e58c9b", "1 3", Marker::kSquare},
};

template <std::size_t kCount>
const SeriesStyle* find_style(const std::array<NamedStyle, kCount>& styles, std::string_view name) {
  const auto* found = std::find_if(styles.begin(), styles.end(),
                                   [&](const NamedStyle& entry) { return entry.system == name; });
  return found == styles.end() ? nullptr : &found->style;
}

constexpr std::string_view kLightCss =
    ".figure text{font-family:'DejaVu Sans',Verdana,Arial,sans-serif;font-size:13px;fill:#1a1a1a}"
    ".figure .small{font-size:11px}.figure .title{font-size:14px;font-weight:bold}"
    ".figure .strong{font-weight:bold}.figure .muted{fill:#595959}"
    ".figure .paper{fill:#ffffff}.figure .panel{fill:#dfdfda;stroke:#c9c9c4;stroke-width:1}"
    ".figure .axis{stroke:#595959;stroke-width:1;fill:none}"
    ".figure .grid{stroke:#dcdcd8;stroke-width:1;fill:none}"
    ".figure .wall{stroke:#9a9a94;stroke-width:2;fill:none}"
    ".figure .wall-over{stroke:#c8102e;stroke-width:1.2;fill:none}"
    ".figure .dimension{stroke:#0072B2;stroke-width:1.4;fill:none}"
    ".figure .dimension-head{fill:#0072B2}"
    ".figure .interval{stroke:#1a1a1a;stroke-width:2.4;fill:none}.figure .thin{stroke-width:1.6}"
    ".figure .limit{stroke:#AA3377;stroke-width:1.6;stroke-dasharray:6 4;fill:none}"
    ".figure .hint{stroke:#8a8a84;stroke-width:1.5;stroke-dasharray:1 "
    "5;stroke-linecap:round;fill:none}"
    ".figure .halo{stroke:#ffffff;stroke-width:4;stroke-linejoin:round;paint-order:stroke}"
    ".figure .clique{fill:#ffffff;stroke:#1a1a1a;stroke-width:1.2}"
    ".figure .clique-out{stroke:#D55E00;stroke-width:2;stroke-dasharray:6 3}"
    ".figure .clique-new{stroke:#0072B2;stroke-width:3.2}"
    ".figure .clique-again{fill:none;stroke:#008560;stroke-width:1.4}"
    ".figure .clique-kept{fill:#e4e4df}.figure .orphan{stroke-dasharray:2 3}"
    ".figure .path{fill:none;stroke-width:2;stroke-linejoin:round}"
    ".figure .line-truth{stroke-width:7;stroke-opacity:0.35}"
    ".figure .dot{fill-opacity:0.75}.figure image{image-rendering:pixelated}\n";

constexpr std::string_view kDarkCss =
    ".figure text{fill:#ececec}.figure .muted{fill:#b4b4b4}.figure .paper{fill:#15171b}"
    ".figure .panel{fill:#1f2227;stroke:#454a52}.figure .axis{stroke:#b4b4b4}"
    ".figure .grid{stroke:#343840}.figure .wall{stroke:#7c828c}.figure .wall-over{stroke:#ff6b7d}"
    ".figure .dimension{stroke:#5aaee6}.figure .dimension-head{fill:#5aaee6}"
    ".figure .clique{fill:#15171b;stroke:#ececec}.figure .clique-out{stroke:#ff8a3d}"
    ".figure .clique-new{stroke:#5aaee6}.figure .clique-again{fill:none;stroke:#2ccf9f}"
    ".figure .clique-kept{fill:#343840}"
    ".figure .limit{stroke:#e38bc4}.figure .interval{stroke:#ececec}.figure .halo{stroke:#15171b}";

template <class Visit>
void for_each_style(Visit&& visit) {
  visit(kTruth);
  for (const NamedStyle& entry : kSystems) visit(entry.style);
  for (const SeriesStyle& style : kSpares) visit(style);
}

}  // namespace

const SeriesStyle* system_style(std::string_view system) { return find_style(kSystems, system); }

const SeriesStyle& spare_style(std::size_t index) { return kSpares[index % kSpares.size()]; }

const SeriesStyle& line_style(std::size_t index) {
  const std::size_t place = index % (kSpares.size() + kSystems.size());
  return place < kSpares.size() ? kSpares[place] : kSystems[place - kSpares.size()].style;
}

const SeriesStyle& truth_style() { return kTruth; }

std::string figure_css() {
  std::string light(kLightCss);
  std::string dark(kDarkCss);
  for_each_style([&](const SeriesStyle& style) {
    light += fmt::format(".figure .line-{}{{stroke:{}{}}}.figure .fill-{}{{fill:{}}}\n", style.name,
                         style.light,
                         style.dash.empty() ? "" : fmt::format(";stroke-dasharray:{}", style.dash),
                         style.name, style.light);
    dark += fmt::format(".figure .line-{}{{stroke:{}}}.figure .fill-{}{{fill:{}}}", style.name,
                        style.dark, style.name, style.dark);
  });
  // Behind the dashes of the lines, which a whisker is too short for.
  light += ".figure .whisker{stroke-width:1.2;stroke-opacity:0.6;stroke-dasharray:none}\n";
  return fmt::format("{}@media screen and (prefers-color-scheme:dark){{{}}}\n", light, dark);
}

double text_width_px(std::string_view text, double font_size_px) {
  const auto num_characters = std::count_if(text.begin(), text.end(), [](char character) {
    return (static_cast<unsigned char>(character) & 0xC0U) != 0x80U;
  });
  return static_cast<double>(num_characters) * kCharacterWidth_ratio * font_size_px;
}

std::string elided(std::string_view text, double width_px) {
  if (text_width_px(text) <= width_px) return std::string(text);
  std::size_t end = text.size();
  const auto is_inside_character = [&] {
    return end > 0 && (static_cast<unsigned char>(text[end]) & 0xC0U) == 0x80U;
  };
  do {
    do --end;
    while (is_inside_character());
  } while (end > 0 && text_width_px(text.substr(0, end)) + kFontSize_px > width_px);
  return std::string(text.substr(0, end)) + "…";
}

double label_column_px(const std::vector<std::string>& labels) {
  double widest_px = 0;
  for (const std::string& label : labels) widest_px = std::max(widest_px, text_width_px(label));
  return std::clamp(widest_px + kLabelGap_px, kMinLabelColumn_px, kMaxLabelColumn_px);
}

}  // namespace corridor::figures
