#include <unistd.h>

#include <hompm/kit/recorder/bytes.hpp>
#include <hompm/plan/fields.hpp>

namespace hompm::detail {

void add_bytes(Hash& hash, std::string_view bytes) {
  while (!bytes.empty()) {
    const auto part = bytes.substr(0, 8);
    std::uint64_t word = 0;
    for (std::size_t i = 0; i < part.size(); ++i)
      word |= std::uint64_t{static_cast<unsigned char>(part[i])} << (8 * i);
    hash.add(word);
    bytes.remove_prefix(part.size());
  }
}

std::uint64_t hash_of_bytes(std::string_view bytes) {
  Hash hash;
  add_bytes(hash, bytes);
  hash.add(bytes.size());
  return hash.value();
}

void write_state(ByteWriter& out, const State& state) {
  visit_fields(state, [&](const FieldInfo& info, auto values) {
    out.text(info.name);
    out.word(values.size());
    for (const auto value : values) out.word(word_of(value));
  });
}

void read_state(ByteReader& in, State& state) {
  visit_fields(state, [&](const FieldInfo& info, auto values) {
    const std::string found = in.text();
    if (found != info.name)
      throw Error("it has the field " + found + " in place of " + std::string(info.name));
    if (in.count(8) != values.size()) throw Error("its field " + found + " does not fit its scene");
    for (auto& value : values) read_value(in, value);
  });
  const auto refuse = [](const char* field) {
    throw Error(std::string("its field ") + field + " does not fit its scene");
  };
  if (state.step < 0) refuse("step");
  for (const double boundary : {state.left_boundary, state.right_boundary})
    if (state.grid.locate(boundary).cell < 0) refuse("left_boundary or right_boundary");
  const std::int64_t last = state.grid.functions() - static_cast<std::int64_t>(state.basis.stencil);
  for (const std::int32_t first : state.basis.first)
    if (first < 0 || first > last) refuse("basis.first");  // kernels read from there on
}

}  // namespace hompm::detail
