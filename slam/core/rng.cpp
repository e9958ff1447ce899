#include "slam/core/rng.hpp"

#include <Random123/philox.h>

#include <cmath>
#include <numbers>

#include "slam/core/expect.hpp"

namespace corridor {
namespace {

// Finaliser of SplitMix64: a bijection that spreads every input bit over the key.
std::uint64_t mix(std::uint64_t value) {
  value += 0x9e3779b97f4a7c15ULL;
  value = (value ^ (value >> 30)) * 0xbf58476d1ce4e5b9ULL;
  value = (value ^ (value >> 27)) * 0x94d049bb133111ebULL;
  return value ^ (value >> 31);
}

// FNV-1a, 64 bits.
std::uint64_t hash_name(std::string_view name) {
  std::uint64_t hash = 0xcbf29ce484222325ULL;
  for (const char c : name) {
    hash = (hash ^ static_cast<unsigned char>(c)) * 0x100000001b3ULL;
  }
  return hash;
}

// Keeps a name and an index with the same 64 bits apart.
constexpr std::uint64_t kNameDomain = 0x6e616d65ULL;
constexpr std::uint64_t kIndexDomain = 0x696e6478ULL;

}  // namespace

Rng::Rng(std::uint64_t seed) : key_(mix(seed)) {}

Rng Rng::stream(std::string_view name) const {
  Rng child(0);
  child.key_ = mix(key_ ^ mix(hash_name(name) ^ kNameDomain));
  return child;
}

Rng Rng::stream(std::uint64_t index) const {
  Rng child(0);
  child.key_ = mix(key_ ^ mix(mix(index) ^ kIndexDomain));
  return child;
}

std::uint32_t Rng::next_u32() {
  if (num_used_ == 4) {
    const r123::Philox4x32 philox;
    const r123::Philox4x32::ctr_type counter{{static_cast<std::uint32_t>(block_index_),
                                              static_cast<std::uint32_t>(block_index_ >> 32), 0u,
                                              0u}};
    const r123::Philox4x32::key_type key{
        {static_cast<std::uint32_t>(key_), static_cast<std::uint32_t>(key_ >> 32)}};
    const auto words = philox(counter, key);
    block_ = {words[0], words[1], words[2], words[3]};
    ++block_index_;
    num_used_ = 0;
  }
  return block_[static_cast<std::size_t>(num_used_++)];
}

std::uint64_t Rng::next_u64() {
  const std::uint64_t high = next_u32();
  return (high << 32) | next_u32();
}

double Rng::uniform() { return static_cast<double>(next_u64() >> 11) * 0x1.0p-53; }

double Rng::uniform(double low, double high) { return low + (high - low) * uniform(); }

double Rng::normal() {
  const double radius = std::sqrt(-2 * std::log1p(-uniform()));
  return radius * std::cos(2 * std::numbers::pi * uniform());
}

double Rng::normal(double mean, double standard_deviation) {
  return mean + standard_deviation * normal();
}

std::uint64_t Rng::below(std::uint64_t bound) {
  CORRIDOR_EXPECT(bound > 0);
  const std::uint64_t rejected = (0 - bound) % bound;  // 2^64 mod bound
  std::uint64_t value = next_u64();
  while (value < rejected) value = next_u64();
  return value % bound;
}

}  // namespace corridor
