#include "datasets/formats/rawlog/rawlog_framing.hpp"

#include <fmt/format.h>

#include <array>
#include <cstdint>
#include <cstring>
#include <optional>

#include "datasets/formats/parsed_log.hpp"
#include "datasets/formats/text.hpp"

namespace corridor::formats {
namespace {

constexpr std::uint8_t kEndFlag = 0x88;
constexpr std::uint8_t kNewHeaderFlag = 0x80;  // set in the length of a class name since MRPT 0.5.5
constexpr std::size_t kMaxNameLength = 120;    // MRPT's own limit
constexpr std::uint32_t kMaxLabelBytes = 256;
constexpr std::uint32_t kMaxCommentBytes = 1u << 20;
constexpr std::uint32_t kMaxObjectsInFrame = 1024;
constexpr std::uint32_t kMaxActions = 16;  // of one collection, which MRPT holds with its samples
constexpr std::uint32_t kMaxMatrixSide = 16;
constexpr std::uint32_t kMaxMotionSamples = 100'000;  // MRPT draws that many while it reads
constexpr std::size_t kNumImuValues = 31;             // COUNT_IMU_DATA_FIELDS of MRPT 2.5
constexpr std::size_t kStampBytes = 8;

std::string_view without_namespace(std::string_view name) {
  const std::size_t colon = name.rfind(':');
  return colon == std::string_view::npos ? name : name.substr(colon + 1);
}

// Walks along the bytes. The first violation is kept; every step after it is a no-op.
class Walker {
 public:
  Walker(std::string_view bytes, const std::string& file) : bytes_(bytes), file_(file) {}

  [[nodiscard]] bool at_end() const { return offset_ == bytes_.size(); }
  [[nodiscard]] bool has_failed() const { return error_.has_value(); }
  [[nodiscard]] const Error& error() const { return *error_; }
  [[nodiscard]] std::size_t offset() const { return offset_; }

  void refuse(ErrorCode code, std::size_t offset, std::string what, std::string expected) {
    if (has_failed()) return;
    error_ = Error{code, std::move(what), fmt::format("{}: byte {}", file_, offset),
                   std::move(expected)};
  }

  void skip(std::size_t num_bytes, std::string_view what) {
    if (has_failed()) return;
    if (num_bytes > bytes_.size() - offset_) {
      refuse(ErrorCode::kMalformed, bytes_.size(), fmt::format("the file ends inside {}", what),
             fmt::format("{} more bytes", num_bytes - (bytes_.size() - offset_)));
      return;
    }
    offset_ += num_bytes;
  }

  template <class T>
  T take(std::string_view what) {
    const std::size_t begin = offset_;
    skip(sizeof(T), what);
    T value{};
    if (!has_failed()) std::memcpy(&value, bytes_.data() + begin, sizeof(T));
    return value;
  }

  std::uint32_t take_count(std::uint32_t max, std::string_view what) {
    const std::size_t begin = offset_;
    const auto count = take<std::uint32_t>(what);
    if (!has_failed() && count > max) {
      refuse(ErrorCode::kMalformed, begin, fmt::format("{} is {}", what, count),
             fmt::format("at most {}", max));
      return 0;
    }
    return has_failed() ? 0 : count;
  }

  bool take_flag(std::string_view what) {
    const std::size_t begin = offset_;
    const auto value = take<std::uint8_t>(what);
    if (value > 1)
      refuse(ErrorCode::kMalformed, begin, fmt::format("{} is {}", what, value), "0 or 1");
    return value == 1;
  }

  std::string_view take_text(std::size_t length, std::string_view what) {
    const std::size_t begin = offset_;
    skip(length, what);
    return has_failed() ? std::string_view() : bytes_.substr(begin, length);
  }

 private:
  std::string_view bytes_;
  const std::string& file_;
  std::size_t offset_ = 0;
  std::optional<Error> error_;
};

class RawlogGrammar {
 public:
  explicit RawlogGrammar(Walker& walker) : w_(walker) {}

  // One object with its header and end flag. Returns its class name.
  std::string_view object(std::string_view parent) {
    const std::size_t begin = w_.offset();
    const auto length = w_.take<std::uint8_t>("an object's header");
    if (!w_.has_failed() && (length & kNewHeaderFlag) == 0) {
      w_.refuse(ErrorCode::kMalformed, begin, "no object begins here", "an MRPT object header");
    }
    const std::size_t name_length = length & ~static_cast<unsigned>(kNewHeaderFlag);
    if (!w_.has_failed() && (name_length == 0 || name_length > kMaxNameLength)) {
      w_.refuse(ErrorCode::kMalformed, begin,
                fmt::format("class name of {} characters", name_length),
                fmt::format("1 to {}", kMaxNameLength));
    }
    const std::string_view name = without_namespace(w_.take_text(name_length, "a class name"));
    const auto version = w_.take<std::uint8_t>("an object's version");
    body(begin, parent, name, version);
    const std::size_t end = w_.offset();
    const auto flag = w_.take<std::uint8_t>("an object's end flag");
    if (!w_.has_failed() && flag != kEndFlag) {
      w_.refuse(ErrorCode::kMalformed, end, fmt::format("byte 0x{:02x} after {}", flag, name),
                "the end flag 0x88");
    }
    return name;
  }

 private:
  struct Layout {
    std::string_view parent;  // "" = top level
    std::string_view name;
    std::uint8_t version_min;
    std::uint8_t version_max;
    void (RawlogGrammar::*body)(std::uint8_t version);
  };

  void body(std::size_t begin, std::string_view parent, std::string_view name,
            std::uint8_t version) {
    if (w_.has_failed()) return;
    for (const Layout& layout : kLayouts) {
      if (layout.parent != parent || layout.name != name) continue;
      if (version < layout.version_min || version > layout.version_max) {
        w_.refuse(ErrorCode::kUnsupported, begin, fmt::format("{} of version {}", name, version),
                  fmt::format("{} to {}", layout.version_min, layout.version_max));
        return;
      }
      (this->*layout.body)(version);
      return;
    }
    w_.refuse(ErrorCode::kUnsupported, begin, "object of class " + quote(name),
              parent.empty() ? "an observation, a sensory frame or an action collection"
                             : fmt::format("a class that belongs into {}", parent));
  }

  void label() { w_.skip(w_.take_count(kMaxLabelBytes, "length of a label"), "a label"); }

  void comment(std::uint8_t) {
    w_.skip(w_.take_count(kMaxCommentBytes, "length of the comment"), "the comment");
    w_.skip(kStampBytes, "a stamp");
  }

  void scan(std::uint8_t version) {
    w_.skip(4, "a scan's aperture");
    w_.take_flag("a scan's direction");
    w_.skip(4, "a scan's maximum range");
    object("CObservation2DRangeScan");
    if (version < 6) object("CObservation2DRangeScan");  // a covariance of the sensor's pose
    const std::size_t n = w_.take_count(static_cast<std::uint32_t>(kMaxBeams), "number of beams");
    w_.skip(4 * n, "a scan's ranges");
    for (std::size_t i = 0; i < n && !w_.has_failed(); ++i) w_.take_flag("a beam's validity");
    w_.skip(4 + kStampBytes + 4, "a scan");  // range sigma, stamp, beam aperture
    if (version >= 5) {
      label();
      w_.skip(8, "a scan's pitch");
    }
    if (version >= 7 && w_.take_flag("a scan's intensity flag")) w_.skip(4 * n, "intensities");
  }

  void odometry(std::uint8_t version) {
    object("CObservationOdometry");
    label();
    w_.skip(kStampBytes, "a stamp");
    if (version == 0) return;
    const bool has_ticks = w_.take_flag("odometry's encoder flag");
    if (has_ticks || version < 2) w_.skip(8, "encoder ticks");
    const bool has_velocity = w_.take_flag("odometry's velocity flag");
    if (version < 2) {
      w_.skip(8, "velocities");
    } else if (has_velocity) {
      w_.skip(24, "velocities");
    }
  }

  void imu(std::uint8_t version) {
    object("CObservationIMU");
    const std::size_t num_flags =
        version >= 4 ? kNumImuValues : w_.take_count(kNumImuValues, "number of IMU flags");
    for (std::size_t i = 0; i < num_flags && !w_.has_failed(); ++i) w_.take_flag("an IMU flag");
    w_.skip(kStampBytes, "a stamp");
    const std::size_t num_values =
        version >= 4 ? kNumImuValues : w_.take_count(kNumImuValues, "number of IMU values");
    w_.skip((version == 0 ? 4 : 8) * num_values, "IMU values");
    label();
  }

  void objects(std::string_view parent, std::uint32_t max) {
    const std::uint32_t n = w_.take_count(max, "number of objects");
    for (std::uint32_t i = 0; i < n && !w_.has_failed(); ++i) object(parent);
  }

  void sensory_frame(std::uint8_t version) {
    if (version < 2) w_.skip(4, "a sensory frame's number");
    if (version == 0) w_.skip(kStampBytes, "a stamp");
    objects("CSensoryFrame", kMaxObjectsInFrame);
  }

  void actions(std::uint8_t) { objects("CActionCollection", kMaxActions); }

  void movement(std::uint8_t version) {
    const std::size_t begin = w_.offset();
    const auto method = w_.take<std::uint32_t>("a movement's method");
    if (!w_.has_failed() && method != 0) {
      w_.refuse(ErrorCode::kUnsupported, begin, "a movement that is not odometry", "method 0");
    }
    object("CActionRobotMovement2D");
    w_.skip(4 + 6 * 4, "a motion model");
    w_.take_count(kMaxMotionSamples, "number of motion samples");
    w_.skip((version >= 5 ? 6 : 4) * 4, "a motion model");
    const bool has_velocity = w_.take_flag("a movement's velocity flag");
    w_.skip(version < 7 ? 8 : (has_velocity ? 24 : 0), "velocities");
    const bool has_ticks = w_.take_flag("a movement's encoder flag");
    w_.skip(version < 7 || has_ticks ? 8 : 0, "encoder ticks");
    if (version >= 6) w_.skip(kStampBytes, "a stamp");
  }

  void pose2(std::uint8_t version) { w_.skip(version == 0 ? 12 : 24, "a planar pose"); }

  void pose3(std::uint8_t version) {
    if (version <= 1) {
      object("CPose3D");  // a homogeneous matrix
    } else {
      w_.skip(version == 2 ? 56 : 96, "a pose");
    }
  }

  void matrix(std::size_t bytes_per_value) {
    const std::size_t rows = w_.take_count(kMaxMatrixSide, "number of matrix rows");
    const std::size_t columns = w_.take_count(kMaxMatrixSide, "number of matrix columns");
    w_.skip(rows * columns * bytes_per_value, "a matrix");
  }
  void matrix_of_floats(std::uint8_t) { matrix(4); }
  void matrix_of_doubles(std::uint8_t) { matrix(8); }

  static const std::array<Layout, 18> kLayouts;

  Walker& w_;
};

// Which class may stand where, and the versions whose layout is known here: MRPT 0.5.5 to 2.5.
using G = RawlogGrammar;
const std::array<RawlogGrammar::Layout, 18> RawlogGrammar::kLayouts = {{
    {"", "CObservationComment", 0, 0, &G::comment},
    {"", "CObservation2DRangeScan", 4, 7, &G::scan},
    {"", "CObservationOdometry", 0, 2, &G::odometry},
    {"", "CObservationIMU", 0, 4, &G::imu},
    {"", "CSensoryFrame", 0, 2, &G::sensory_frame},
    {"", "CActionCollection", 0, 0, &G::actions},
    {"CSensoryFrame", "CObservation2DRangeScan", 4, 7, &G::scan},
    {"CSensoryFrame", "CObservationOdometry", 0, 2, &G::odometry},
    {"CSensoryFrame", "CObservationIMU", 0, 4, &G::imu},
    {"CActionCollection", "CActionRobotMovement2D", 4, 7, &G::movement},
    {"CActionRobotMovement2D", "CPose2D", 0, 1, &G::pose2},
    {"CObservationOdometry", "CPose2D", 0, 1, &G::pose2},
    {"CObservationIMU", "CPose3D", 0, 3, &G::pose3},
    {"CObservation2DRangeScan", "CPose3D", 0, 3, &G::pose3},
    {"CObservation2DRangeScan", "CMatrix", 0, 0, &G::matrix_of_floats},
    {"CPose3D", "CMatrix", 0, 0, &G::matrix_of_floats},
    {"CPose3D", "CMatrixF", 0, 0, &G::matrix_of_floats},
    {"CPose3D", "CMatrixD", 0, 0, &G::matrix_of_doubles},
}};

}  // namespace

Result<std::vector<RawlogFrame>> check_rawlog_frames(std::string_view bytes,
                                                     const std::string& file) {
  Walker walker(bytes, file);
  RawlogGrammar grammar(walker);
  std::vector<RawlogFrame> frames;
  while (!walker.at_end() && !walker.has_failed()) {
    const std::size_t begin = walker.offset();
    const std::string_view name = grammar.object("");
    frames.push_back({name, begin, walker.offset() - begin});
  }
  if (walker.has_failed()) return tl::make_unexpected(walker.error());
  return frames;
}

}  // namespace corridor::formats
