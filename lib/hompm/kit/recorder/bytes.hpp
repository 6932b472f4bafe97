// Values, and all fields of a state, as bytes that mean the same on every machine, and a hash of them.
#pragma once

#include <bit>
#include <concepts>
#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>

#include <hompm/plan/state.hpp>

namespace hompm::detail {

/// The 64 bits of a value: those of a double, an integer with its sign.
inline std::uint64_t word_of(double value) { return std::bit_cast<std::uint64_t>(value); }
inline std::uint64_t word_of(std::integral auto value) { return static_cast<std::uint64_t>(value); }

/// A hash of 64-bit words: h ← (h ⊕ w) · 1099511628211, then h ← h ⊕ (h >> 32), from 14695981039346656037.
/// This is FNV-1a (Fowler, Noll, Vo) taken a word at a time; the shift brings the highest bits down, which
/// the product alone would leave at the top, so that two changed signs would cancel. Every step can be
/// undone: a change in one word always changes the hash.
class Hash {
 public:
  void add(std::uint64_t word) {
    value_ = (value_ ^ word) * 1099511628211U;
    value_ ^= value_ >> 32U;
  }
  [[nodiscard]] std::uint64_t value() const { return value_; }

 private:
  std::uint64_t value_ = 14695981039346656037U;
};

/// Adds `bytes` as little-endian words, the last one filled up with zeros.
void add_bytes(Hash& hash, std::string_view bytes);
/// The hash of `bytes` and then of their number.
std::uint64_t hash_of_bytes(std::string_view bytes);

/// Appends little-endian values to a text.
class ByteWriter {
 public:
  /// The lowest `Size` bytes of `value`.
  template <int Size = 8>
  void word(std::uint64_t value) {
    for (int i = 0; i < Size; ++i) bytes.push_back(static_cast<char>((value >> (8 * i)) & 0xffU));
  }
  void number(double value) { word(word_of(value)); }
  void text(std::string_view value) {
    word(value.size());
    bytes += value;
  }
  std::string bytes;
};

/// Bytes end where a value should be.
class BytesEnd : public Error {
 public:
  BytesEnd() : Error("the data ends too early") {}
};

/// Reads what `ByteWriter` wrote; each throws `BytesEnd` when there is not enough left.
class ByteReader {
 public:
  explicit ByteReader(std::string_view bytes) : rest_(bytes) {}

  std::string_view raw(std::uint64_t size) {
    if (size > rest_.size()) throw BytesEnd();
    const auto part = rest_.substr(0, static_cast<std::size_t>(size));
    rest_.remove_prefix(part.size());
    return part;
  }
  template <int Size = 8>
  std::uint64_t word() {
    std::uint64_t value = 0;
    int shift = 0;
    for (const char byte : raw(Size)) {
      value |= std::uint64_t{static_cast<unsigned char>(byte)} << shift;
      shift += 8;
    }
    return value;
  }
  double number() { return std::bit_cast<double>(word()); }
  std::string text() { return std::string(raw(word())); }
  /// A number of entries that follow, of at least `entry_size` bytes each: never more than there can be.
  std::size_t count(std::uint64_t entry_size) {
    const std::uint64_t entries = word();
    if (entries > rest_.size() / entry_size) throw BytesEnd();
    return static_cast<std::size_t>(entries);
  }
  [[nodiscard]] std::size_t left() const { return rest_.size(); }

 private:
  std::string_view rest_;
};

/// Appends every field of the state, with its name and its number of values.
void write_state(ByteWriter& out, const State& state);

/// Reads what `write_state` wrote into a state of the same scene. Throws `Error` when a field is not what the
/// scene makes it, and `BytesEnd`.
void read_state(ByteReader& in, State& state);

inline void read_value(ByteReader& in, double& value) { value = in.number(); }
inline void read_value(ByteReader& in, std::integral auto& value) {
  value = static_cast<std::remove_reference_t<decltype(value)>>(in.word());
}

}  // namespace hompm::detail
