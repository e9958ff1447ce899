#include "reports/figures/raster.hpp"

#include <cairo.h>
#include <fmt/format.h>
#include <librsvg/rsvg.h>

#include <algorithm>
#include <cmath>
#include <memory>

namespace corridor::figures {
namespace {

struct GObjectUnref {
  void operator()(gpointer object) const { g_object_unref(object); }
};
struct CairoDestroy {
  void operator()(cairo_t* context) const { cairo_destroy(context); }
  void operator()(cairo_surface_t* surface) const { cairo_surface_destroy(surface); }
};
using Handle = std::unique_ptr<RsvgHandle, GObjectUnref>;
using Surface = std::unique_ptr<cairo_surface_t, CairoDestroy>;
using Context = std::unique_ptr<cairo_t, CairoDestroy>;

tl::unexpected<Error> fail_with(GError* error, const std::string& what) {
  std::string message = what;
  if (error != nullptr) {
    message += fmt::format(" ({})", error->message);
    g_error_free(error);
  }
  return fail(ErrorCode::kInternal, message);
}

cairo_status_t append_bytes(void* closure, const unsigned char* data, unsigned int length) {
  static_cast<std::string*>(closure)->append(reinterpret_cast<const char*>(data), length);
  return CAIRO_STATUS_SUCCESS;
}

Result<std::string> encode(cairo_surface_t* surface) {
  std::string png;
  const cairo_status_t status = cairo_surface_write_to_png_stream(surface, append_bytes, &png);
  if (status == CAIRO_STATUS_SUCCESS) return png;
  return fail(ErrorCode::kInternal,
              fmt::format("cairo could not encode a PNG ({})", cairo_status_to_string(status)));
}

std::uint32_t premultiplied(std::uint32_t pixel) {
  const std::uint32_t alpha = pixel >> 24U;
  const auto channel = [&](unsigned shift) {
    return (((pixel >> shift) & 255U) * alpha / 255U) << shift;
  };
  return (alpha << 24U) | channel(16) | channel(8) | channel(0);
}

}  // namespace

Result<std::string> png_from_svg(const std::string& svg, double scale) {
  GError* error = nullptr;
  const Handle handle(
      rsvg_handle_new_from_data(reinterpret_cast<const guint8*>(svg.data()), svg.size(), &error));
  if (!handle) return fail_with(error, "librsvg could not read a figure");
  gdouble width_px = 0;
  gdouble height_px = 0;
  if (rsvg_handle_get_intrinsic_size_in_pixels(handle.get(), &width_px, &height_px) == FALSE) {
    return fail_with(nullptr, "a figure has no size in pixels");
  }
  const RsvgRectangle viewport{0, 0, std::ceil(width_px * scale), std::ceil(height_px * scale)};
  const Surface surface(cairo_image_surface_create(
      CAIRO_FORMAT_RGB24, static_cast<int>(viewport.width), static_cast<int>(viewport.height)));
  const Context context(cairo_create(surface.get()));
  if (rsvg_handle_render_document(handle.get(), context.get(), &viewport, &error) == FALSE) {
    return fail_with(error, "librsvg could not draw a figure");
  }
  return encode(surface.get());
}

Result<std::string> png_from_pixels(const PixelImage& image) {
  const Surface surface(cairo_image_surface_create(CAIRO_FORMAT_ARGB32, image.width, image.height));
  if (cairo_surface_status(surface.get()) != CAIRO_STATUS_SUCCESS) {
    return fail(ErrorCode::kResourceLimit,
                fmt::format("no image of {} x {} pixels", image.width, image.height));
  }
  unsigned char* data = cairo_image_surface_get_data(surface.get());
  const int stride_bytes = cairo_image_surface_get_stride(surface.get());
  for (int row = 0; row < image.height; ++row) {
    auto* line =
        reinterpret_cast<std::uint32_t*>(data + static_cast<std::ptrdiff_t>(row) * stride_bytes);
    const auto begin = image.pixels.begin() + static_cast<std::ptrdiff_t>(row) * image.width;
    std::transform(begin, begin + image.width, line, premultiplied);
  }
  cairo_surface_mark_dirty(surface.get());
  return encode(surface.get());
}

}  // namespace corridor::figures
