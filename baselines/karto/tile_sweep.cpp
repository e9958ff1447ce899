#include "baselines/karto/tile_sweep.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cstring>
#include <limits>

#include "baselines/karto/smear_kernel.hpp"
#include "slam/core/expect.hpp"

namespace corridor::karto {
namespace {

constexpr int kBytes = 32;          // of one vector
constexpr int kLanes = kBytes / 2;  // 16-bit sums in it
constexpr std::size_t kBeamsPerFlush = 32;
static_assert(kBeamsPerFlush * kOccupied <= std::numeric_limits<std::uint16_t>::max());
// A pair of bytes is read as one 16-bit lane: its first byte is the low one.
constexpr std::uint16_t kLowByte = 0xff;
constexpr int kByteBits = 8;
static_assert(std::endian::native == std::endian::little);
static_assert(2 * kOccupied <= std::numeric_limits<std::uint8_t>::max());
constexpr int kWideVectors = 3;
static_assert(TileSweep::kMaxOverrun >= kWideVectors * kBytes);

// Vectors of GCC and Clang, for whatever instructions the build allows: arrays would travel through
// memory, several times slower.
using Bytes [[gnu::vector_size(kBytes)]] = std::uint8_t;
using Lanes [[gnu::vector_size(kBytes)]] = std::uint16_t;

Bytes load(const std::uint8_t* cells) {
  Bytes bytes;
  std::memcpy(&bytes, cells, sizeof(bytes));
  return bytes;
}

// Rows of positions that are summed at once, and vectors of grid cells along each.
template <int kStepCells, int kNumRows, int kNumVectors>
struct TileShape {
  static constexpr int kStep = kStepCells;
  static constexpr int kRows = kNumRows;
  static constexpr int kVectors = kNumVectors;
  static constexpr int kColumnsPerVector = kBytes / kStep;
  static constexpr int kColumns = kVectors * kColumnsPerVector;
};

// 16-bit sums of the positions of a tile: those at even cells, and with steps of one cell those at
// odd cells as well.
template <class Shape>
class TileSums {
 public:
  void add(const std::uint8_t* cells, std::ptrdiff_t row_bytes,
           std::span<const std::int32_t> beams) {
    std::size_t i = 0;
    // Two values fit into a byte.
    for (; i + 2 <= beams.size(); i += 2) {
      for (int v = 0; v < kNumVectors; ++v) {
        const std::uint8_t* const at = cells + offset_of(v, row_bytes);
        add(v, load(at + beams[i]) + load(at + beams[i + 1]));
      }
    }
    if (i == beams.size()) return;
    for (int v = 0; v < kNumVectors; ++v) add(v, load(cells + offset_of(v, row_bytes) + beams[i]));
  }

  // sums[i] += sum at column i of the row, for i < count.
  void flush(int row, int count, std::uint32_t* sums) const {
    for (int first = 0; first < count; first += Shape::kColumnsPerVector) {
      const int v = row * Shape::kVectors + first / Shape::kColumnsPerVector;
      const int end = std::min(count - first, Shape::kColumnsPerVector);
      for (int i = 0; i < end; ++i) {
        if constexpr (Shape::kStep == 2) {
          sums[first + i] += even_[v][i];
        } else {
          sums[first + i] += i % 2 == 0 ? even_[v][i / 2] : odd_[v][i / 2];
        }
      }
    }
  }

 private:
  static constexpr int kNumVectors = Shape::kRows * Shape::kVectors;

  static std::ptrdiff_t offset_of(int vector, std::ptrdiff_t row_bytes) {
    return vector / Shape::kVectors * row_bytes + vector % Shape::kVectors * kBytes;
  }
  void add(int v, Bytes bytes) {
    const auto pairs = reinterpret_cast<Lanes>(bytes);
    even_[v] += pairs & kLowByte;
    if constexpr (Shape::kStep == 1) odd_[v] += pairs >> kByteBits;
  }

  std::array<Lanes, kNumVectors> even_{};
  std::array<Lanes, Shape::kStep == 1 ? kNumVectors : 1> odd_{};
};

}  // namespace

TileSweep::TileSweep(const ByteRows& cells, const SweepWindow& window)
    : cells_(cells), window_(window) {
  CORRIDOR_EXPECT(window.step_cells == 1 || window.step_cells == 2);
}

void TileSweep::add(std::span<const std::int32_t> beams, std::uint32_t* sums) const {
  if (window_.step_cells == 1) {
    add_all<1>(beams, sums);
  } else {
    add_all<2>(beams, sums);
  }
}

int TileSweep::tile_columns() const { return kBytes / window_.step_cells; }

void TileSweep::add_tile(std::span<const std::int32_t> beams, int row, int column,
                         std::uint32_t* sums) const {
  if (window_.step_cells == 1) {
    add_one<1>(beams, row, column, sums);
  } else {
    add_one<2>(beams, row, column, sums);
  }
}

// A wide window by wide tiles, which use up the cache lines they touch.
template <int kStep>
void TileSweep::add_all(std::span<const std::int32_t> beams, std::uint32_t* sums) const {
  int row = 0;
  if (window_.count > 2 * kBytes / kStep) {
    row = add_rows<TileShape<kStep, 2, kWideVectors>>(beams, row, sums);
  }
  row = add_rows<TileShape<kStep, kTileRows, 1>>(beams, row, sums);
  row = add_rows<TileShape<kStep, 3, 1>>(beams, row, sums);
  add_rows<TileShape<kStep, 1, 1>>(beams, row, sums);
}

// As many rows from `row` on as tiles of this shape take; the first row that is left.
template <class Shape>
int TileSweep::add_rows(std::span<const std::int32_t> beams, int row, std::uint32_t* sums) const {
  for (; row + Shape::kRows <= window_.count; row += Shape::kRows) {
    for (int column = 0; column < window_.count; column += Shape::kColumns) {
      add_shape<Shape>(beams, row, column, sums);
    }
  }
  return row;
}

template <int kStep>
void TileSweep::add_one(std::span<const std::int32_t> beams, int row, int column,
                        std::uint32_t* sums) const {
  if (row + kTileRows <= window_.count) {
    return add_shape<TileShape<kStep, kTileRows, 1>>(beams, row, column, sums);
  }
  for (; row < window_.count; ++row) {
    add_shape<TileShape<kStep, 1, 1>>(beams, row, column, sums);
  }
}

template <class Shape>
void TileSweep::add_shape(std::span<const std::int32_t> beams, int row, int column,
                          std::uint32_t* sums) const {
  const std::uint8_t* const cells =
      cells_.first + window_.index_of(row, cells_.stride) + std::int64_t{Shape::kStep} * column;
  const std::ptrdiff_t row_bytes = Shape::kStep * cells_.stride;
  const int count = std::min(Shape::kColumns, window_.count - column);
  while (!beams.empty()) {
    const std::size_t num_beams = std::min(beams.size(), kBeamsPerFlush);
    TileSums<Shape> tile;
    tile.add(cells, row_bytes, beams.first(num_beams));
    beams = beams.subspan(num_beams);
    for (int r = 0; r < Shape::kRows; ++r) {
      tile.flush(r, count, sums + (row + r) * window_.count + column);
    }
  }
}

}  // namespace corridor::karto
