// Random numbers that are the same everywhere.
#pragma once

#include <cstdint>
#include <initializer_list>

namespace hompm::test {

/// splitmix64 (G. L. Steele, D. Lea, C. H. Flood, OOPSLA 2014): seeds in a row give unrelated numbers.
class Random {
 public:
  explicit Random(std::uint64_t seed) : state_(seed) {}
  double between(double low, double high) {
    return low + (high - low) * (static_cast<double>(next() >> 11) * 0x1p-53);
  }
  int whole(int low, int high) {
    return low + static_cast<int>(next() % static_cast<std::uint64_t>(high - low + 1));
  }
  bool chance(double share) { return between(0.0, 1.0) < share; }
  const char* one_of(std::initializer_list<const char*> words) {
    return words.begin()[whole(0, static_cast<int>(words.size()) - 1)];
  }

 private:
  std::uint64_t next() {
    std::uint64_t z = (state_ += 0x9e3779b97f4a7c15u);
    z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9u;
    z = (z ^ (z >> 27)) * 0x94d049bb133111ebu;
    return z ^ (z >> 31);
  }
  std::uint64_t state_;
};

}  // namespace hompm::test
