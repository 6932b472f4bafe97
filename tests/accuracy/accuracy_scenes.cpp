// Scenes whose solution is known, drawn at random: their runs are judged by runs of a better scheme, as if
// nothing were known, and what that says is held against the truth.
//
//     accuracy_scenes [--seed FIRST] [--count N] [--work PART] [--list] [--markdown]
//
// PART (1) of the work that a reference may cost by default is allowed. Fails unless the true error is at
// most the stated bound in 99 % of the fields, and where a run is called good that is not.
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <functional>
#include <map>
#include <string>
#include <vector>

#include <hompm/error.hpp>
#include <hompm/kit/scene_file/reader.hpp>
#include <hompm/kit/verify/made_reference.hpp>
#include <hompm/kit/verify/verdict.hpp>
#include <hompm/number.hpp>
#include <hompm/scene/amplitude.hpp>

#include "support/random.hpp"

namespace {

using hompm::ReferenceFields;
using hompm::Scene;
using hompm::Snapshot;
using hompm::test::Random;

/// u, v and the stress at a point.
struct Point {
  double u = 0.0, v = 0.0, s = 0.0;
};
using Truth = std::function<Point(double time, double X, std::int64_t body)>;

struct Drawn {
  std::string family;
  Scene scene;
  Truth truth;  ///< empty: the reference solution of the scene
};

std::string material(const std::string& law, double density, double modulus, const std::string& more = "") {
  return "material = { law = \"" + law + "\", density = " + hompm::to_text(density) +
         ", youngs_modulus = " + hompm::to_text(modulus) + more + " }\n";
}

/// A scheme for bodies that move far or not, with a step that every one can take.
std::string scheme(Random& random, bool any) {
  const std::string name =
      any ? random.one_of({"classical", "bspline", "cpdi", "apic", "total-lagrangian", "tielen2017", "mls",
                           "tls", "ugimp", "high-order"})
          : random.one_of({"bspline", "apic", "total-lagrangian", "tielen2017", "high-order", "high-order"});
  const char* const cells = random.one_of({"8", "16", "16", "32", "32", "64"});
  const char* const fraction = random.one_of({"0.1", "0.2", "0.4"});
  return "scheme = { name = \"" + name + "\", cells = " + cells +
         ", particles_per_cell = 4, step_fraction = " + fraction + " }\n";
}

std::string text(double value) { return hompm::to_text(value); }

Scene parsed(const std::string& toml) { return hompm::parse_scene(toml, "scene", {}); }

/// One of those that have a reference solution.
Drawn known(Random& random) {
  const int kind = random.whole(0, 7);
  const std::string end = "end_time = " + text(random.between(0.3, 2.5)) + "\n";
  const std::string law = random.one_of({"linear", "linear", "rate", "hencky", "neo-hookean"});
  const std::string bar = "body.length = 1.0\n" + material(law, 1.0, 1.0);
  const double small = law == "linear" ? 0.1 : random.between(0.01, 0.06);
  const std::string swing = "initial.velocity = { shape = \"sine\", amplitude = " + text(small) +
                            ", mode = " + std::to_string(random.whole(1, 3)) + " }\n";
  const std::string load = text(random.between(0.01, 0.05));
  const std::string hung = "ends.right = \"free\"\n";
  const std::string ramp = random.one_of({"0.0", "0.5"});
  const std::string of = scheme(random, true);
  switch (kind) {
    case 0:
    case 1: return {"swinging bar", parsed(end + bar + swing + of), {}};
    case 2:
      return {"column under gravity",
              parsed(end + bar + hung + "effect = [ { type = \"gravity\", acceleration = -" + load +
                     ", ramp_time = " + ramp + " } ]\n" + of),
              {}};
    case 3:
      return {"traction, ramped",
              parsed(end + bar + hung + "effect = [ { type = \"traction\", value = " + load +
                     ", ramp_time = 0.4 } ]\n" + of),
              {}};
    case 4:
      return {"damped bar",
              parsed(end + bar + swing + "effect = [ { type = \"mass-damping\", rate = 1.0 } ]\n" + of),
              {}};
    case 5:
      return {"viscous bar",
              parsed(end + "body.length = 1.0\n" + material("linear", 1.0, 1.0) + swing +
                     "effect = [ { type = \"viscosity\", viscosity = 0.02 } ]\n" + of),
              {}};
    case 6:
      return {"stretched bar that is let go",
              parsed(end + "body.length = 1.0\n" + material("linear", 1.0, 1.0) +
                     "initial.displacement = { shape = \"sine\", amplitude = 0.02, mode = 1 }\n" + of),
              {}};
    default:
      return {"manufactured solution",
              parsed(end + bar + "effect = [ { type = \"manufactured\", amplitude = " + load + " } ]\n" + of),
              {}};
  }
}

/// The built-in cases on coarse grids.
Drawn built_in(Random& random) {
  const std::string name = random.one_of({"bar", "column"});
  const std::string variant = random.one_of({"small", "large"});
  const std::string of = random.one_of({"classical", "bspline", "cpdi", "apic", "total-lagrangian",
                                        "tielen2017", "mls", "tls", "ddmp", "mixed", "cpgimp", "high-order"});
  const std::string cells = random.one_of({"8", "16", "32"});
  const std::string fraction = random.one_of({"0.1", "0.2", "0.4"});
  return {name + " " + variant,
          hompm::load_builtin(name, variant,
                              {{"scheme.name", of, "--scheme"},
                               {"scheme.cells", cells, "--cells"},
                               {"scheme.step_fraction", fraction, "--step-fraction"}}),
          {}};
}

/// A bar of length 1, wave speed and density 1, meets a rigid wall on its right with the speed v0 after t0
/// (d'Alembert).
Point against_wall(double v0, double t0, double time, double X) {
  const double s = time - t0;
  const double stopped = 1.0 - X;  // the wave from the wall comes by
  const double thrown_back = 1.0 + X;
  if (s < stopped) return {v0 * time, v0, 0.0};
  if (s < thrown_back) return {v0 * (t0 + stopped), 0.0, -v0};
  return {v0 * (t0 + stopped) - v0 * (s - thrown_back), -v0, 0.0};
}

Drawn wall(Random& random) {
  const std::string of = scheme(random, false);
  const double end = random.between(1.0, 3.5);
  const double v0 = random.between(0.02, 0.1);
  const double t0 = random.between(0.1, 0.5);
  return {"bar against a wall",
          parsed("end_time = " + text(end) + "\nbody.length = 1.0\n" + material("linear", 1.0, 1.0) +
                 "initial.velocity = { shape = \"uniform\", amplitude = " + text(v0) +
                 " }\nends = { left = \"free\", right = \"free\" }\n" +
                 "effect = [ { type = \"wall\", end = \"right\", position = " + text(1.0 + v0 * t0) +
                 " } ]\n" + of),
          [=](double time, double X, std::int64_t) { return against_wall(v0, t0, time, X); }};
}

Drawn contact(Random& random) {
  const std::string of = scheme(random, false);
  const double end = random.between(1.0, 3.0);
  const double v0 = random.between(0.05, 0.2);
  const double t0 = random.between(0.1, 0.5);
  const double start = 1.0 + v0 * t0;
  return {
      "two equal bars that collide",
      parsed("end_time = " + text(end) + "\n" + material("linear", 1.0, 1.0) +
             "ends = { left = \"free\", right = \"free\" }\nbody = [ { length = 1.0, initial.velocity = { "
             "shape = \"uniform\", amplitude = " +
             text(v0) + " } }, { length = 1.0, start = " + text(start) +
             " } ]\neffect = [ { type = \"contact\" } ]\n" + of),
      [=](double time, double X, std::int64_t body) {
        const Point half = body == 0 ? against_wall(0.5 * v0, t0, time, X)
                                     : against_wall(0.5 * v0, t0, time, 1.0 - (X - start));
        const double sign = body == 0 ? 1.0 : -1.0;  // the other is the mirror image
        return Point{0.5 * v0 * time + sign * half.u, 0.5 * v0 + sign * half.v, half.s};
      }};
}

/// ∫ of a function from 0 to `end`, Simpson.
double integral(const std::function<double(double)>& f, double end) {
  if (end <= 0.0) return 0.0;
  constexpr int parts = 200;
  const double h = end / parts;
  double sum = f(0.0) + f(end);
  for (int i = 1; i < parts; ++i) sum += (i % 2 == 1 ? 4.0 : 2.0) * f(h * i);
  return sum * h / 3.0;
}

/// A pulse from a piston on the left of a first body of length, wave speed and impedance 1 that goes on in a
/// second one of wave speed and impedance c2, and out of that.
Drawn layers(Random& random, bool second) {
  const std::string of = scheme(random, false);
  const double c2 = second ? random.one_of({"2", "4"})[0] - '0' : 1.0;
  const double v = random.between(0.01, 0.1);
  const hompm::Amplitude pulse{.ramp_time = 0.2, .duration = 0.4};
  const double end = second ? random.between(0.6, 1.45) : random.between(0.5, 1.5);
  const std::string both = material("linear", 1.0, 1.0) + "ends = { left = \"free\", right = \"free\" }\n";
  const std::string piston = "{ type = \"piston\", end = \"left\", velocity = " + text(v) +
                             ", ramp_time = 0.2, duration = 0.4" + (second ? ", body = 0 }" : " }");
  const double R = (1.0 - c2) / (1.0 + c2);
  return {
      second ? "pulse through two bonded layers" : "pulse that leaves at an absorbing end",
      parsed("end_time = " + text(end) + "\n" + both +
             (second ? "body = [ { length = 1.0 }, { length = 2.0, start = 1.0, material.youngs_modulus = " +
                           text(c2 * c2) + " } ]\neffect = [ " + piston + ", { type = \"interface\" } ]\n"
                     : "body.length = 1.0\neffect = [ " + piston +
                           ", { type = \"absorbing\", end = \"right\" } ]\n") +
             of),
      [=](double time, double X, std::int64_t body) {
        const auto V = [&](double at) { return at > 0.0 ? v * pulse(at) : 0.0; };
        if (body == 1) {
          const double at = time - 1.0 - (X - 1.0) / c2;
          return Point{(1.0 + R) * integral(V, at), (1.0 + R) * V(at), -c2 * (1.0 + R) * V(at)};
        }
        const double there = time - X;
        const double back = time - 2.0 + X;
        const double r = second ? R : 0.0;
        return Point{integral(V, there) + r * integral(V, back), V(there) + r * V(back),
                     -V(there) + r * V(back)};
      }};
}

/// A simple wave of the law rate, E = ρ = 1: v keeps V(s) along X = exp(V(s)) (t − s), and λ = exp(−v).
Drawn piston(Random& random) {
  const std::string of = scheme(random, false);
  const double end = random.between(0.4, 0.85);
  const double most = random.between(0.02, 0.1);
  const hompm::Amplitude amplitude{.ramp_time = 0.5};
  return {
      "piston, simple wave",
      parsed("end_time = " + text(end) + "\nbody.length = 1.0\n" + material("rate", 1.0, 1.0) +
             "ends = { left = \"free\", right = \"fixed\" }\neffect = [ { type = \"piston\", end = \"left\", "
             "velocity = " +
             text(most) + ", ramp_time = 0.5 } ]\n" + of),
      [=](double time, double X, std::int64_t) {
        const auto v_at = [&](double t) {
          double low = 0.0;
          double high = t;
          if (X >= t) return 0.0;
          for (int i = 0; i < 60; ++i) {
            const double s = 0.5 * (low + high);
            (X < std::exp(most * amplitude(s)) * (t - s) ? low : high) = s;
          }
          return most * amplitude(low);
        };
        const double v = v_at(time);
        return Point{integral([&](double after) { return v_at(X + after); }, time - X), v, 1.0 - std::exp(v)};
      }};
}

/// Fronts that run into a body of length 1 at rest from its right end, behind each a constant state.
struct Front {
  double speed, v, s;
};
Truth fronts(std::vector<Front> all) {
  return [all = std::move(all)](double time, double X, std::int64_t) {
    Point point;
    for (const Front& front : all) {
      const double since = time - (1.0 - X) / front.speed;
      if (since <= 0.0) break;
      point = {point.u + (front.v - point.v) * since, front.v, front.s};
    }
    return point;
  };
}

Drawn shock(Random& random) {
  const std::string of = scheme(random, false);
  const double end = random.between(0.3, 0.6);
  const double p = random.between(0.05, 0.4);
  const double stretch = 1.0 / (1.0 + p);
  const double v = -(1.0 / std::sqrt(stretch) - std::sqrt(stretch));
  return {"shock with bulk viscosity",
          parsed("end_time = " + text(end) + "\nbody.length = 1.0\n" + material("rate", 1.0, 1.0) +
                 "ends = { left = \"free\", right = \"free\" }\neffect = [ { type = \"traction\", value = -" +
                 text(p) + " }, { type = \"bulk-viscosity\" } ]\n" + of),
          fronts({{1.0 / std::sqrt(stretch), v, -p}})};
}

Drawn plasticity(Random& random) {
  const std::string of = scheme(random, false);
  const double end = random.between(0.4, 0.9);
  const double pull = random.between(0.02, 0.05);
  return {"elastic-plastic wave",
          parsed("end_time = " + text(end) + "\nbody.length = 1.0\n" +
                 material("elastoplastic", 1.0, 1.0, ", yield_stress = 0.01, tangent_modulus = 0.25") +
                 "ends.right = \"free\"\neffect = [ { type = \"traction\", value = " + text(pull) + " } ]\n" +
                 of),
          fronts({{1.0, 0.01, 0.01}, {0.5, 0.01 + (pull - 0.01) / 0.5, pull}})};
}

Drawn draw(std::uint64_t seed) {
  Random random(seed);
  switch (random.whole(0, 11)) {
    case 0: return wall(random);
    case 1: return contact(random);
    case 2: return layers(random, true);
    case 3: return layers(random, false);
    case 4: return piston(random);
    case 5: return shock(random);
    case 6: return plasticity(random);
    case 7:
    case 8: return built_in(random);
    default: return known(random);
  }
}

ReferenceFields true_fields(const Drawn& drawn, const Snapshot& final) {
  if (!drawn.truth) {
    auto reference = hompm::make_reference(drawn.scene);
    ReferenceFields fields = reference.value().at(final.time, final.reference_position);
    if (reference->estimated_error().displacement > 1e-4) throw hompm::Error("no truth");
    return fields;
  }
  ReferenceFields fields;
  for (std::size_t i = 0; i < final.size(); ++i) {
    const Point point =
        drawn.truth(final.time, final.reference_position[i], final.body.empty() ? 0 : final.body[i]);
    fields.displacement.push_back(point.u);
    fields.velocity.push_back(point.v);
    fields.stress.push_back(point.s);
  }
  return fields;
}

/// Of one family, or all.
struct Count {
  int scenes = 0, unjudged = 0, fields = 0, held = 0, near = 0, wrongly_good = 0;
  std::map<std::string, int> levels = {};
  double worst = 0.0;  ///< true error over bound
  std::string worst_scene = {};
};

std::string described(std::uint64_t seed, const Drawn& drawn) {
  return "seed " + std::to_string(seed) + ", " + drawn.scene.scheme.name + ", " +
         std::to_string(drawn.scene.scheme.cells) + " cells";
}

void judge(std::uint64_t seed, double work, bool list, std::map<std::string, Count>& counts) {
  Drawn drawn;
  hompm::TimeStepping stepping;
  hompm::RunResult result;
  hompm::RunMotion motion;
  ReferenceFields fields;
  try {
    drawn = draw(seed);
    stepping = hompm::time_stepping(drawn.scene);
    hompm::RunObserver observer;
    observer.snapshot = [&](const Snapshot& snapshot) { motion.look(drawn.scene, snapshot); };
    result = hompm::run(drawn.scene, stepping, observer);
    fields = true_fields(drawn, result.final);
  } catch (const hompm::Error&) {
    return;  // it cannot be run, or has become a shock, of which nothing is known
  }
  Count& family = counts[drawn.family];
  Count& all = counts["all"];
  std::string reason;
  const double budget = work * hompm::reference_budget(drawn.scene, stepping, false);
  const auto errors = hompm::judge_by_runs(drawn.scene, result, budget, reason, {}, motion);
  const auto verdict = hompm::verdict_of(drawn.scene, result, errors, reason, motion);
  const auto truth = hompm::detail::report_of(drawn.scene, result.final, fields, {}, motion);
  double most_true = 0.0;
  std::string line;
  for (const auto& field : hompm::error_fields) {
    const double is = truth.bound.*field.error;
    most_true = std::max(most_true, is);
    if (!errors) continue;
    const double bound = errors->bound.*field.error;
    constexpr double of_rounding = 1e-9;
    for (Count* count : {&family, &all}) {
      ++count->fields;
      count->held += is <= bound + of_rounding ? 1 : 0;
      count->near += (bound >= 0.5 * is && bound <= 5.0 * is) || std::max(is, bound) < of_rounding ? 1 : 0;
      if (const double ratio = is / (bound + of_rounding); ratio > count->worst) {
        count->worst = ratio;
        count->worst_scene = std::string(field.name) + " of " + described(seed, drawn);
      }
    }
    char buffer[100];
    std::snprintf(buffer, sizeof buffer, "  %8.2e/%8.2e%s", bound, is, is <= bound + of_rounding ? " " : "!");
    line += buffer;
  }
  const bool wrong = verdict.level == hompm::VerdictLevel::good && most_true > 0.05;
  for (Count* count : {&family, &all}) {
    ++count->scenes;
    count->unjudged += errors ? 0 : 1;
    count->wrongly_good += wrong ? 1 : 0;
    ++count->levels[hompm::to_string(verdict.level)];
  }
  if (list)
    std::printf("%-40s %-34s%s %s %s%s\n", drawn.family.c_str(), described(seed, drawn).c_str(), line.c_str(),
                errors ? to_string(errors->kind) : reason.c_str(), hompm::to_string(verdict.level),
                wrong ? " WRONG" : "");
}

std::string share(int part, int whole) {
  char buffer[32];
  std::snprintf(buffer, sizeof buffer, "%.1f %%", whole > 0 ? 100.0 * part / whole : 0.0);
  return buffer;
}

}  // namespace

int main(int argc, char** argv) {
  std::uint64_t first = 1;
  int count = 100;
  double work = 1.0;
  bool list = false;
  for (int i = 1; i < argc; ++i) {
    const auto is = [&](const char* name) { return std::strcmp(argv[i], name) == 0; };
    if (is("--list"))
      list = true;
    else if (is("--seed") && i + 1 < argc)
      first = std::strtoull(argv[++i], nullptr, 10);
    else if (is("--count") && i + 1 < argc)
      count = std::atoi(argv[++i]);
    else if (is("--work") && i + 1 < argc)
      work = std::atof(argv[++i]);
    else {
      std::fprintf(stderr, "accuracy_scenes: unknown option %s\n", argv[i]);
      return 2;
    }
  }
  std::map<std::string, Count> counts;
  for (int i = 0; i < count; ++i) judge(first + static_cast<std::uint64_t>(i), work, list, counts);
  std::printf(
      "| scenes | | good | doubtful | bad | unknown | bound held | bound/error from 0.5 to 5 | worst "
      "error/bound |\n");
  std::printf("| --- | ---: | ---: | ---: | ---: | ---: | ---: | ---: | --- |\n");
  for (auto& [family, c] : counts)
    std::printf("| %s | %d | %d | %d | %d | %d | %s | %s | %.2f: %s |\n", family.c_str(), c.scenes,
                c.levels["good"], c.levels["doubtful"], c.levels["bad"], c.levels["unknown"],
                share(c.held, c.fields).c_str(), share(c.near, c.fields).c_str(), c.worst,
                c.worst_scene.c_str());
  const Count& all = counts["all"];
  const bool fine = all.scenes > count / 2 && all.held >= 0.99 * all.fields && all.wrongly_good == 0;
  if (!fine) std::printf("%d called good are not\n", all.wrongly_good);
  return fine ? 0 : 1;
}
