#include "reports/figures/svg.hpp"

#include <fmt/format.h>

#include <cmath>
#include <utility>

#include "reports/escape.hpp"

namespace corridor::figures {
namespace {

using reports::escape_html;

// A hundredth of a pixel is finer than any print of these figures.
std::string px(double value) {
  std::string text = fmt::format("{:.2f}", value);
  text.erase(text.find_last_not_of('0') + 1);
  if (text.back() == '.') text.pop_back();
  return text == "-0" ? "0" : text;
}

std::string_view anchor_text(Anchor anchor) {
  switch (anchor) {
    case Anchor::kStart:
      return "start";
    case Anchor::kMiddle:
      return "middle";
    case Anchor::kEnd:
      return "end";
  }
  return "start";
}

}  // namespace

Svg::Svg(std::string id, double width_px, double height_px, std::string title,
         std::string description)
    : id_(std::move(id)),
      title_(std::move(title)),
      description_(std::move(description)),
      width_px_(std::ceil(width_px)),  // whole pixels: no half-covered line at the edge of the PNG
      height_px_(std::ceil(height_px)) {}

void Svg::line(double x1, double y1, double x2, double y2, std::string_view classes) {
  body_ += fmt::format("<line x1=\"{}\" y1=\"{}\" x2=\"{}\" y2=\"{}\" class=\"{}\"/>\n", px(x1),
                       px(y1), px(x2), px(y2), classes);
}

void Svg::rect(double x, double y, double width, double height, std::string_view classes,
               double corner_radius) {
  const std::string corners =
      corner_radius > 0 ? fmt::format(" rx=\"{}\"", px(corner_radius)) : std::string();
  body_ += fmt::format("<rect x=\"{}\" y=\"{}\" width=\"{}\" height=\"{}\"{} class=\"{}\"/>\n",
                       px(x), px(y), px(width), px(height), corners, classes);
}

void Svg::polyline(const std::vector<Eigen::Vector2d>& points, std::string_view classes) {
  body_ += "<polyline points=\"";
  for (const Eigen::Vector2d& point : points) {
    body_ += fmt::format("{},{} ", px(point.x()), px(point.y()));
  }
  body_ += fmt::format("\" class=\"{}\"/>\n", classes);
}

void Svg::marker(Marker shape, double x, double y, double radius, std::string_view classes) {
  const double r = radius;
  switch (shape) {
    case Marker::kCircle:
      body_ += fmt::format("<circle cx=\"{}\" cy=\"{}\" r=\"{}\" class=\"{}\"/>\n", px(x), px(y),
                           px(r), classes);
      return;
    case Marker::kSquare:
      return rect(x - 0.9 * r, y - 0.9 * r, 1.8 * r, 1.8 * r, classes);
    case Marker::kTriangle:
      return path(fmt::format("M{} {}L{} {}L{} {}Z", px(x), px(y - 1.2 * r), px(x + 1.1 * r),
                              px(y + 0.8 * r), px(x - 1.1 * r), px(y + 0.8 * r)),
                  classes);
    case Marker::kDiamond:
      return path(fmt::format("M{0} {1}L{2} {3}L{0} {4}L{5} {3}Z", px(x), px(y - 1.25 * r),
                              px(x + 1.25 * r), px(y), px(y + 1.25 * r), px(x - 1.25 * r)),
                  classes);
  }
}

void Svg::path(std::string_view d, std::string_view classes) {
  body_ += fmt::format("<path d=\"{}\" class=\"{}\"/>\n", escape_html(d), classes);
}

void Svg::text(double x, double y, std::string_view content, std::string_view classes,
               Anchor anchor, double rotation_deg) {
  const std::string rotation = rotation_deg == 0 ? std::string()
                                                 : fmt::format(" transform=\"rotate({} {} {})\"",
                                                               px(rotation_deg), px(x), px(y));
  body_ += fmt::format("<text x=\"{}\" y=\"{}\" text-anchor=\"{}\" class=\"{}\"{}>{}</text>\n",
                       px(x), px(y), anchor_text(anchor), classes, rotation, escape_html(content));
}

void Svg::image(std::string_view png, std::string_view transform) {
  body_ += fmt::format(
      "<image width=\"1\" height=\"1\" preserveAspectRatio=\"none\" transform=\"{}\" "
      "xlink:href=\"data:image/png;base64,{}\"/>\n",
      escape_html(transform), reports::base64(png));
}

void Svg::begin_clip(double x, double y, double width, double height) {
  const std::string clip_id = fmt::format("{}-clip-{}", id_, num_clips_++);
  body_ += fmt::format(
      "<clipPath id=\"{0}\"><rect x=\"{1}\" y=\"{2}\" width=\"{3}\" height=\"{4}\"/></clipPath>\n"
      "<g clip-path=\"url(#{0})\">\n",
      escape_html(clip_id), px(x), px(y), px(width), px(height));
}

void Svg::end_group() { body_ += "</g>\n"; }

std::string Svg::document(std::string_view style) const {
  return fmt::format(
      "<svg xmlns=\"http://www.w3.org/2000/svg\" xmlns:xlink=\"http://www.w3.org/1999/xlink\" "
      "class=\"figure\" width=\"{1}\" height=\"{2}\" viewBox=\"0 0 {1} {2}\" role=\"img\" "
      "aria-labelledby=\"{0}-title {0}-description\">\n<title id=\"{0}-title\">{3}</title>\n"
      "<desc id=\"{0}-description\">{4}</desc>\n{5}<rect width=\"100%\" height=\"100%\" "
      "class=\"paper\"/>\n{6}</svg>\n",
      escape_html(id_), px(width_px_), px(height_px_), escape_html(title_),
      escape_html(description_), style, body_);
}

std::string Svg::element() const { return document(""); }

std::string Svg::file() const {
  return "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n" +
         document("<style>" + figure_css() + "</style>\n");
}

}  // namespace corridor::figures
