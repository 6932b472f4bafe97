#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <utility>
#include <vector>

#include <hompm/simulation/probes.hpp>

namespace hompm::detail {
namespace {

/// Those of a body in a snapshot.
struct BodyParticles {
  std::size_t first, last;
};

BodyParticles particles_of(const Snapshot& snapshot, std::size_t body) {
  if (snapshot.body.empty()) return {0, snapshot.size() - 1};
  const auto begin = snapshot.body.begin();
  const auto [first, end] = std::equal_range(begin, snapshot.body.end(), static_cast<std::int64_t>(body));
  return {static_cast<std::size_t>(first - begin), static_cast<std::size_t>(end - begin) - 1};
}

/// The value at `place` on the line through the two of the particles that are nearest by `places`.
double on_line(const BodyParticles& of, const std::vector<double>& places, const std::vector<double>& values,
               double place) {
  if (of.first == of.last) return values[of.first];
  std::size_t i = of.first;
  while (i + 2 <= of.last && places[i + 1] <= place) ++i;
  const double part = (place - places[i]) / (places[i + 1] - places[i]);
  return values[i] + part * (values[i + 1] - values[i]);
}

std::optional<ProbeRow> row_of(const Snapshot& snapshot, const ProbeSpec& probe, const BodyParticles& of,
                               const Body& body) {
  double X = probe.X.value_or(probe.end == "right" ? body.right() : body.left());
  if (probe.x) X = on_line(of, snapshot.position, snapshot.reference_position, *probe.x);
  if (X < body.left() || X > body.right()) return std::nullopt;
  ProbeRow row{.time = snapshot.time};
  for (std::size_t column = 0; column < row.values.size(); ++column)
    row.values[column] = on_line(of, snapshot.reference_position, snapshot.*probe_columns[column].values, X);
  row.values[0] = X;
  if (probe.x) row.values[1] = *probe.x;
  return row;
}

}  // namespace

void tell_probes(const Scene& scene, const Snapshot& snapshot,
                 const std::function<bool(const ProbeSpec&)>& due,
                 const std::function<void(const ProbeRow&)>& told) {
  const std::vector<const Scene*> bodies = bodies_of(scene);
  for (std::size_t number = 0; number < scene.probes.size(); ++number) {
    const ProbeSpec& probe = scene.probes[number];
    std::optional<ProbeRow> row;
    for (std::size_t body = 0; body < bodies.size() && !row && due(probe); ++body)
      if (!probe.body || std::cmp_equal(*probe.body, body))
        row = row_of(snapshot, probe, particles_of(snapshot, body), bodies[body]->body);
    if (!row) continue;
    row->probe = number;
    told(*row);
  }
}

}  // namespace hompm::detail
