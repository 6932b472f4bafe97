#include "memory.hpp"

#include <array>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <string>
#include <sys/resource.h>
#include <unistd.h>

#include <hompm/error.hpp>

namespace hompm::cli {
namespace {

struct Limit {
  double bytes;
  std::string name;
};

void lower(Limit& limit, double bytes, const std::string& name) {
  if (bytes < limit.bytes) limit = {bytes, name};
}

void lower_by_resource(Limit& limit, decltype(RLIMIT_AS) resource, const std::string& name) {
  struct rlimit set {};
  if (::getrlimit(resource, &set) == 0 && set.rlim_cur != RLIM_INFINITY)
    lower(limit, static_cast<double>(set.rlim_cur), name);
}

/// Those of the group and of all above it; "max" and a file that is not there are none.
void lower_by_control_groups(Limit& limit) {
  std::ifstream groups("/proc/self/cgroup");
  for (std::string line; std::getline(groups, line);) {
    const auto first = line.find(':');
    const auto second = line.find(':', first + 1);
    if (second == std::string::npos) continue;
    const std::string controllers = line.substr(first + 1, second - first - 1);
    const bool unified = controllers.empty();
    if (!unified && controllers != "memory") continue;
    const std::string root = unified ? "/sys/fs/cgroup" : "/sys/fs/cgroup/memory";
    const char* const file = unified ? "memory.max" : "memory.limit_in_bytes";
    std::filesystem::path path = line.substr(second + 1);
    for (;; path = path.parent_path()) {
      std::ifstream set(root / path.relative_path() / file);
      double bytes = 0.0;
      if (set >> bytes) lower(limit, bytes, "the control group");
      if (!path.has_relative_path()) break;
    }
  }
}

std::string megabytes(double bytes) {
  std::array<char, 32> text{};
  std::snprintf(text.data(), text.size(), "%.0f MB", bytes / 1e6);
  return text.data();
}

}  // namespace

double estimated_memory(const Scene& scene, const Keeps& keeps) {
  constexpr double program = 16e6;
  double bytes = program;
  for (const Scene* body : bodies_of(scene)) {
    const SchemeSpec& scheme = body->scheme;
    const double cells = scheme.cells + 2.0 * scheme.margin_cells;
    const double particles = 1.0 * scheme.cells * scheme.particles_per_cell;
    const double functions = scheme.degree + 1.0;  // that a particle sees
    double each = 372.0 + 64.0 * functions;
    if (keeps.checkpoints) each += 3.0 * 64.0 * (scene.output.snapshots + 1.0) + 130.0;
    if (keeps.trace) each += 100.0 + 16.0 * functions;
    bytes += particles * each;
    bytes += cells * (scheme.choices.quadrature == Quadrature::particles ? 80.0 : 600.0);
  }
  return bytes;
}

void demand_memory(const Scene& scene, const Keeps& keeps) {
  const double needed = estimated_memory(scene, keeps);
  Limit limit{static_cast<double>(::sysconf(_SC_PHYS_PAGES)) * static_cast<double>(::sysconf(_SC_PAGESIZE)),
              "the machine"};
  lower_by_resource(limit, RLIMIT_AS, "ulimit -v");
  lower_by_resource(limit, RLIMIT_DATA, "ulimit -d");
  lower_by_control_groups(limit);
  if (needed <= limit.bytes) return;
  const auto said = scene.origins.find("scheme.cells");
  throw SceneError(said == scene.origins.end() ? Origin{"scheme.cells"} : said->second,
                   "the run needs about " + megabytes(needed) + " of memory, and " + limit.name + " has " +
                       megabytes(limit.bytes) + ": take fewer cells or particles" +
                       (keeps.checkpoints ? ", or fewer snapshots, which checkpoints hold" : ""));
}

}  // namespace hompm::cli
