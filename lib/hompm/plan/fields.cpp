#include <algorithm>
#include <cstring>

#include <hompm/error.hpp>
#include <hompm/plan/fields.hpp>

namespace hompm {

std::vector<double>& State::operator[](Field field) {
  if (field.index < core_fields.size())
    return *std::get<std::vector<double>*>(core_fields[field.index].of(*this));
  return declared[field.index - core_fields.size()].values;
}

std::vector<double>* State::find(std::string_view name) {
  const auto found = std::ranges::find(declared, name, &DeclaredField::name);
  return found == declared.end() ? nullptr : &found->values;
}

FieldInfo info_of(const State& state, Field field) {
  if (field.index < core_fields.size()) return core_fields[field.index].info;
  const std::size_t index = field.index - core_fields.size();
  if (index >= state.declared.size()) throw Error("a field that its plan has not declared");
  return state.declared[index].info();
}

bool operator==(const State& a, const State& b) {
  std::vector<std::span<const std::byte>> bytes;
  visit_fields(a, [&](const FieldInfo&, auto values) { bytes.push_back(std::as_bytes(values)); });
  std::size_t next = 0;
  bool same = true;
  visit_fields(b, [&](const FieldInfo&, auto values) {
    same = same && next < bytes.size() && std::ranges::equal(bytes[next], std::as_bytes(values));
    ++next;
  });
  return same && next == bytes.size();
}

}  // namespace hompm
