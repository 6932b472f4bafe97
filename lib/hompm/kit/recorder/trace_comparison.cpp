#include <algorithm>
#include <cmath>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <utility>

#include <hompm/kit/recorder/trace.hpp>
#include <hompm/kit/recorder/trace_file.hpp>
#include <hompm/kit/verify/compare.hpp>
#include <hompm/number.hpp>

namespace hompm {
namespace {

using detail::TraceEntry;
using detail::TraceField;
using detail::TraceFile;

std::string text_of(std::uint64_t word, bool is_integer) {
  if (is_integer) return std::to_string(static_cast<std::int64_t>(word));
  const auto value = std::bit_cast<double>(word);
  if (std::isnan(value)) return "not a number";
  if (std::isinf(value)) return value > 0.0 ? "infinity" : "-infinity";
  return to_text(value);
}

std::uint64_t distance(std::uint64_t a, std::uint64_t b, bool is_integer) {
  constexpr std::uint64_t sign = std::uint64_t{1} << 63U;
  const std::uint64_t x = is_integer ? a ^ sign : detail::ordered_bits(std::bit_cast<double>(a));
  const std::uint64_t y = is_integer ? b ^ sign : detail::ordered_bits(std::bit_cast<double>(b));
  return std::max(x, y) - std::min(x, y);
}

/// Particles and markers of a body.
std::size_t sites_of(const TraceFile& file, std::size_t body) {
  const auto& fields = file.fields;
  const auto of_body = [&](const auto& f) { return f.site == Site::particle && f.body == body; };
  const auto found = std::find_if(fields.begin(), fields.end(), of_body);
  return found == fields.end() ? 1 : found->size;
}

/// Particles are numbered as in the tables, through all bodies.
std::string particle_text(const TraceFile& file, std::size_t body, std::size_t site) {
  if (site < file.markers) return "the marker at the left end";
  if (site >= sites_of(file, body) - file.markers) return "the marker at the right end";
  std::size_t number = site - file.markers;
  for (std::size_t before = 0; before < body; ++before) number += sites_of(file, before) - 2 * file.markers;
  return "particle " + std::to_string(number);
}

bool has_several_bodies(const TraceFile& file) { return file.fields.back().body > 0; }

std::string place_of(const TraceFile& file, const TraceField& field, std::size_t entry) {
  if (field.site == Site::body) return "";
  if (field.site == Site::function) return "grid function " + std::to_string(entry);
  if (field.site == Site::particle) return particle_text(file, field.body, entry);
  const std::size_t stencil = field.size / sites_of(file, field.body);
  return particle_text(file, field.body, entry / stencil) + ", function " + std::to_string(entry % stencil) +
         " there";
}

std::optional<TraceValues> first_values(const TraceFile& file, const TraceField& a, const TraceField& b) {
  if (a.values.empty() || b.values.empty()) return {};
  std::optional<TraceValues> first;
  detail::ByteReader in_a(a.values);
  detail::ByteReader in_b(b.values);
  for (std::size_t entry = 0; entry < a.size; ++entry) {
    const auto x = in_a.word();
    const auto y = in_b.word();
    if (x == y) continue;
    if (!first)
      first = TraceValues{.place = place_of(file, a, entry),
                          .a = x,
                          .b = y,
                          .text_a = text_of(x, a.is_integer),
                          .text_b = text_of(y, a.is_integer),
                          .distance = distance(x, y, a.is_integer),
                          .is_integer = a.is_integer,
                          .differing = 0,
                          .size = a.size};
    ++first->differing;
  }
  return first;
}

/// The traces, and what is found about them.
struct Pair {
  TraceFile a, b;
  TraceComparison found = {};

  void differ(std::string message) {
    found.identical = false;
    found.messages.push_back(std::move(message));
  }

  /// True when the field differs now; it is then the first difference.
  bool parts(std::size_t field, std::int64_t step, int part, const detail::TraceStage& stage) {
    const TraceField& x = a.fields[field];
    const TraceField& y = b.fields[field];
    if (x.hash == y.hash) return false;
    found.identical = false;
    found.first = {.step = step,
                   .part = part,
                   .stage = stage.name,
                   .called_by = stage.called_by,
                   .field = x.name,
                   .body = has_several_bodies(a) ? std::optional(x.body) : std::nullopt,
                   .values = first_values(a, x, y),
                   .missing_in = {}};
    if (x.values.empty()) found.first->missing_in = "A";
    if (y.values.empty()) found.first->missing_in += x.values.empty() ? " and B" : "B";
    return true;
  }
};

std::string in_both(const std::string& a, const std::string& b) {
  std::string text = " is ";
  text.append(a).append(" in A and ").append(b).append(" in B");
  return text;
}

bool same_shape(Pair& pair) {
  const auto& [a, b, found] = pair;
  for (std::size_t i = 0; i < std::max(a.stages.size(), b.stages.size()); ++i) {
    const std::string in_a = i < a.stages.size() ? a.stages[i].name : "none";
    const std::string in_b = i < b.stages.size() ? b.stages[i].name : "none";
    if (in_a == in_b) continue;
    pair.differ("the plans differ: stage " + std::to_string(i) + in_both("`" + in_a + "`", "`" + in_b + "`"));
    return false;
  }
  for (std::size_t i = 0; i < std::max(a.fields.size(), b.fields.size()); ++i) {
    const auto text = [&](const TraceFile& file) {
      if (i >= file.fields.size()) return std::string("none");
      const TraceField& field = file.fields[i];
      return field.name + (has_several_bodies(file) ? " of body " + std::to_string(field.body) : "") +
             " with " + std::to_string(field.size) + (field.size == 1 ? " value" : " values");
    };
    if (text(a) == text(b)) continue;
    pair.differ("the states differ: field " + std::to_string(i) + in_both(text(a), text(b)));
    return false;
  }
  return true;
}

void note_origins(Pair& pair) {
  auto& notes = pair.found.notes;
  const auto [line_a, line_b] = detail::first_different_lines(pair.a.scene, pair.b.scene);
  if (line_a != line_b) notes.push_back("the scenes differ: `" + line_a + "` in A, `" + line_b + "` in B");
  if (pair.a.build != pair.b.build) notes.push_back("A is by " + pair.a.build + "; B by " + pair.b.build);
  for (const TraceFile* file : {&pair.a, &pair.b})
    if (!file->complete())
      notes.push_back(std::string(file == &pair.a ? "A" : "B") +
                      " has no end: the run was cut off, or still goes on");
}

/// Both to the state with which the later one begins. False when one ends before that, or they differ there.
bool align(Pair& pair) {
  auto& [a, b, found] = pair;
  const std::int64_t begin = found.first_step = std::max(a.first_step, b.first_step);
  for (TraceFile* file : {&a, &b}) {
    while (file->next() && file->next()->step <= begin && file->first_step < begin) file->take();
    if (file->next() || file->step() >= begin) continue;
    pair.differ(std::string(file == &a ? "A" : "B") + " ends at step " + std::to_string(file->step()) +
                ", before the other begins at step " + std::to_string(begin));
    return false;
  }
  for (std::size_t field = 0; field < a.fields.size(); ++field)
    if (pair.parts(field, begin, 0, {"the state with which the traces begin", ""})) return false;
  return true;
}

/// The next entry of either, and of both when both have it. An ended trace changes nothing any more, but only
/// within its last step.
std::optional<TraceEntry> take_next(Pair& pair) {
  auto& [a, b, found] = pair;
  const auto over = [](const TraceFile& one, const TraceFile& other) {
    return !one.next() && !(one.complete() && other.next() && other.next()->step <= one.step());
  };
  if (over(a, b) || over(b, a)) return {};
  const TraceEntry entry = !a.next() ? *b.next() : !b.next() ? *a.next() : std::min(*a.next(), *b.next());
  for (TraceFile* file : {&a, &b})
    if (file->next() == entry) file->take();
  return entry;
}

}  // namespace

TraceComparison compare_traces(const std::filesystem::path& path_a, const std::filesystem::path& path_b) {
  Pair pair{TraceFile(path_a, path_a.string()), TraceFile(path_b, path_b.string())};
  auto& [a, b, found] = pair;
  note_origins(pair);
  if (!same_shape(pair) || !align(pair)) return found;
  while (const auto entry = take_next(pair))
    if (pair.parts(entry->field, entry->step, entry->part, a.stages[entry->stage])) return found;
  found.last_step = std::min(a.step(), b.step());
  if (a.step() == b.step() && (a.next() || b.next()))
    pair.differ(std::string(a.next() ? "B" : "A") + " breaks off within step " + std::to_string(a.step()) +
                "; up to there they are the same");
  for (TraceFile* file : {&a, &b})
    while (file->next()) file->take();
  if (a.step() != b.step())
    pair.differ("A ends at step " + std::to_string(a.step()) + ", B at step " + std::to_string(b.step()) +
                "; up to there they are the same");
  return found;
}

}  // namespace hompm
