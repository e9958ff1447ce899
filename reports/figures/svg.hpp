// A small SVG writer: shapes with class names, text as text, images as data. All text is escaped.
// It knows no data and no layout; colours come from the style sheet of style.hpp alone, so that one
// figure serves light and dark pages.
#pragma once

#include <Eigen/Core>
#include <string>
#include <string_view>
#include <vector>

#include "reports/figures/style.hpp"

namespace corridor::figures {

enum class Anchor { kStart, kMiddle, kEnd };

class Svg {
 public:
  // `id` names the figure in the page; `title` and `description` are read out by screen readers.
  Svg(std::string id, double width_px, double height_px, std::string title,
      std::string description);

  void line(double x1, double y1, double x2, double y2, std::string_view classes);
  void rect(double x, double y, double width, double height, std::string_view classes,
            double corner_radius = 0);
  void polyline(const std::vector<Eigen::Vector2d>& points, std::string_view classes);
  void marker(Marker shape, double x, double y, double radius, std::string_view classes);
  // `d` is a path in SVG's own syntax, made by the caller from numbers only.
  void path(std::string_view d, std::string_view classes);
  void text(double x, double y, std::string_view content, std::string_view classes = "",
            Anchor anchor = Anchor::kStart, double rotation_deg = 0);
  // Places the unit square of a PNG image (origin in its upper left corner) by the matrix of
  // `transform`.
  void image(std::string_view png, std::string_view transform);
  // Everything until end_group() is cut at the rectangle.
  void begin_clip(double x, double y, double width, double height);
  void end_group();

  [[nodiscard]] const std::string& id() const { return id_; }
  [[nodiscard]] const std::string& title() const { return title_; }
  [[nodiscard]] const std::string& description() const { return description_; }
  [[nodiscard]] double width_px() const { return width_px_; }
  // The element alone, for a page that brings figure_css() itself.
  [[nodiscard]] std::string element() const;
  // A file of its own, with the style sheet inside.
  [[nodiscard]] std::string file() const;

 private:
  [[nodiscard]] std::string document(std::string_view style) const;

  std::string id_, title_, description_;
  double width_px_, height_px_;
  int num_clips_ = 0;
  std::string body_;
};

}  // namespace corridor::figures
