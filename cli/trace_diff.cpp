#include "trace_diff.hpp"

#include <array>
#include <charconv>
#include <iostream>

#include <nlohmann/json.hpp>

#include <hompm/recorder/trace_comparison.hpp>

#include "common.hpp"

namespace hompm::cli {
namespace {

std::string hex(std::uint64_t word) {
  std::array<char, 16> digits{};
  const auto end = std::to_chars(digits.data(), digits.data() + digits.size(), word, 16).ptr;
  const std::string text(digits.data(), end);
  return "0x" + std::string(digits.size() - text.size(), '0') + text;
}

std::string distance_text(const TraceValues& v) {
  const std::string count = std::to_string(v.distance);
  if (v.is_integer) return count + " apart";
  return count + (v.distance == 1 ? " ulp apart" : " ulps apart");
}

void print_difference(const TraceDifference& d) {
  std::cout << "first difference: step " << d.step;
  if (d.part > 1) std::cout << ", part " << d.part << " of it";
  std::cout << ", " << d.stage;
  if (!d.called_by.empty()) std::cout << " (" << d.called_by << ")";
  std::cout << ", " << d.field;
  if (d.body) std::cout << " of body " << *d.body;
  if (!d.values) {
    std::cout << "\n  its values are not in " << d.missing_in
              << ": run both scenes again with --trace-values " << d.step << "\n";
    return;
  }
  const TraceValues& v = *d.values;
  if (!v.place.empty()) std::cout << ", " << v.place;
  std::cout << "\n  A  " << hex(v.a) << "  " << v.text_a << "\n  B  " << hex(v.b) << "  " << v.text_b
            << "\n  " << distance_text(v);
  if (v.size > 1) std::cout << "; " << v.differing << " of the " << v.size << " values of the field differ";
  std::cout << "\n";
}

void print_text(const TraceComparison& found) {
  std::cout << (found.identical ? "identical" : "different") << "\n";
  if (found.first) print_difference(*found.first);
  if (found.identical)
    std::cout << "steps " << found.first_step << " to " << found.last_step
              << ": every field after every stage\n";
  for (const auto& message : found.messages) std::cout << message << "\n";
  for (const auto& note : found.notes) std::cout << "note: " << note << "\n";
}

nlohmann::ordered_json json_of(const TraceDifference& d) {
  nlohmann::ordered_json json{
      {"step", d.step}, {"part", d.part}, {"stage", d.stage}, {"called_by", d.called_by}, {"field", d.field}};
  if (d.body) json["body"] = *d.body;
  if (d.values)
    json.update({{"place", d.values->place},
                 {"a", hex(d.values->a)},
                 {"b", hex(d.values->b)},
                 {d.values->is_integer ? "distance" : "ulps", d.values->distance},
                 {"differing", d.values->differing},
                 {"values", d.values->size}});
  return json;
}

void print_json(const std::string& a, const std::string& b, const TraceComparison& found) {
  const nlohmann::ordered_json json{
      {"verdict", found.identical ? "identical" : "different"},
      {"a", a},
      {"b", b},
      {"messages", found.messages},
      {"notes", found.notes},
      {"first", found.first ? json_of(*found.first) : nlohmann::ordered_json()}};
  std::cout << json.dump(2, ' ', false, nlohmann::ordered_json::error_handler_t::replace) << '\n';
}

}  // namespace

int diff_traces(const std::string& a, const std::string& b, Report report) {
  const TraceComparison found = compare_traces(a, b);
  if (report == Report::text) print_text(found);
  if (report == Report::json) print_json(a, b, found);
  return found.identical ? success : different;
}

}  // namespace hompm::cli
