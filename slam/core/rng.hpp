// Random numbers that depend only on (seed, stream name, position): the counter-based generator
// Philox4x32-10 [Salmon2011], through Random123. No global state, no distribution with memory.
// Two streams with different names or indices never share a number, whatever order they are used
// in.
#pragma once

#include <array>
#include <cstdint>
#include <string_view>

namespace corridor {

class Rng {
 public:
  explicit Rng(std::uint64_t seed);

  // An independent generator for a named purpose, from its own beginning: "wheels", "lidar".
  [[nodiscard]] Rng stream(std::string_view name) const;
  // An independent generator per index: particle, step, seed.
  [[nodiscard]] Rng stream(std::uint64_t index) const;

  std::uint32_t next_u32();
  std::uint64_t next_u64();
  // Uniform in [0, 1), 53 bits.
  double uniform();
  // Uniform in [low, high).
  double uniform(double low, double high);
  // Standard normal by Box-Muller, two uniforms a call, nothing kept between calls.
  double normal();
  double normal(double mean, double standard_deviation);
  // Uniform integer in [0, bound), bound > 0, without modulo bias.
  std::uint64_t below(std::uint64_t bound);

 private:
  std::uint64_t key_;
  std::uint64_t block_index_ = 0;
  std::array<std::uint32_t, 4> block_{};
  int num_used_ = 4;
};

}  // namespace corridor
