// How every figure looks: one palette, one type size, one set of class names. The colours are those
// of [Okabe2008], which people with any kind of colour blindness can tell apart; dash patterns and
// marker shapes say the same once more for grey prints.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

namespace corridor::figures {

// Font size of everything but titles [px of a figure].
inline constexpr double kFontSize_px = 13;
// Average advance of one character of the sans-serif fonts in use, in font sizes; errs on the wide
// side.
inline constexpr double kCharacterWidth_ratio = 0.6;

enum class Marker { kCircle, kSquare, kTriangle, kDiamond };

// How one series is drawn in every figure.
struct SeriesStyle {
  std::string_view name;   // of the SVG classes "line-NAME" and "fill-NAME"
  std::string_view light;  // colour on white
  std::string_view dark;   // colour on a dark page
  std::string_view dash;   // stroke-dasharray, "" for a full line
  Marker marker = Marker::kCircle;
};

// The style of a system of the suite; nullptr for other names.
const SeriesStyle* system_style(std::string_view system);
// Styles for everything else; they repeat after six.
const SeriesStyle& spare_style(std::size_t index);
// Styles for figures without systems: the spares, then those of systems; they repeat after
// fourteen.
const SeriesStyle& line_style(std::size_t index);
const SeriesStyle& truth_style();

// The style sheet of all figures, for light and dark: stands in each SVG file and once in the page.
std::string figure_css();

// Estimated width of a text [px].
double text_width_px(std::string_view text, double font_size_px = kFontSize_px);
// The text, or as much of its beginning as fits with an ellipsis.
std::string elided(std::string_view text, double width_px);
// Width of a column of labels at the left of a figure: as wide as they need, within limits.
double label_column_px(const std::vector<std::string>& labels);

}  // namespace corridor::figures
