#include "run_picture.hpp"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <iostream>
#include <map>
#include <optional>
#include <span>
#include <utility>

#include <nlohmann/json.hpp>

#include <hompm/kit/scene_file/reader.hpp>
#include <hompm/kit/verify/judge.hpp>
#include <hompm/kit/verify/particle_table.hpp>
#include <hompm/number.hpp>

#include "child.hpp"
#include "scene_run.hpp"

namespace hompm::cli {
namespace {

namespace fs = std::filesystem;
using gnuplot::Curve;
using gnuplot::Panel;
using gnuplot::Stroke;
using Values = std::vector<double>;

struct FieldName {
  const char* name;
  const char* symbol;
  const char* unit;
  Values ReferenceFields::*exact;
};
constexpr FieldName drawn_fields[] = {{"displacement", "u", "m", &ReferenceFields::displacement},
                                      {"velocity", "v", "m/s", &ReferenceFields::velocity},
                                      {"stress", "σ", "Pa", &ReferenceFields::stress}};
constexpr const char* energies[] = {"kinetic", "stored", "gravity", "dissipated", "external_work"};

/// The exact solution of a run, as far as there is one.
struct Exact {
  std::string reason = {};                                ///< why there is none, or none to the end
  std::map<std::size_t, ReferenceFields> particles = {};  ///< by snapshot
  Values times = {};
  std::vector<Values> probes = {};  ///< displacements at `times`
  double own_error = 0.0;           ///< relative L2 of the displacement
};

/// What a run left in its folder.
struct Run {
  Scene scene;
  std::string label, colour;
  detail::ParticleFields fields;
  std::map<std::string, Values> history;
  std::vector<std::size_t> probes;  ///< particles that are followed in time
  Exact exact;

  [[nodiscard]] const Values& values(const std::string& field, std::size_t time) const {
    return fields.values(field, time);
  }
  [[nodiscard]] std::size_t last() const { return fields.blocks.size() - 1; }
  [[nodiscard]] double time(std::size_t k) const { return fields.blocks[k].time; }
};

/// Ends of bodies; of a single one those that move, or its middle.
std::vector<std::size_t> probes_of(const Scene& scene, const detail::ParticleBlock& start) {
  std::vector<std::size_t> probes;
  const std::size_t n = start.X.size();
  const auto body = [&](std::size_t p) { return start.body.empty() ? 0 : start.body[p]; };
  const auto moves = [&](End end) { return !scene.bodies.empty() || end == End::free; };
  for (std::size_t p = 0; p < n; ++p) {
    const bool first = p == 0 || body(p - 1) != body(p);
    const bool last = p + 1 == n || body(p + 1) != body(p);
    if ((first && moves(scene.ends.left)) || (last && moves(scene.ends.right))) probes.push_back(p);
  }
  if (probes.empty() && n > 0) probes.push_back(n / 2);
  return probes;
}

Run read_run(const std::string& folder) {
  const fs::path path(folder);
  std::error_code none;
  for (const char* file : {"scene.toml", "particles.csv", "stress.csv", "history.csv"})
    if (!fs::exists(path / file, none))
      throw FileError("cannot draw " + folder + ": it holds no run (" + file + " is missing)");
  Run run;
  run.scene = load_scene((path / "scene.toml").string(), {});
  const SchemeSpec& scheme = run.scene.scheme;
  run.label =
      scheme.name + ", p = " + std::to_string(scheme.degree) + ", " + std::to_string(scheme.cells) + " cells";
  detail::MessageLog faults, notes;
  run.fields = detail::read_golden(path, faults, notes);
  const auto whole = [&](const detail::ParticleBlock& block) {
    return block.X.size() == run.fields.blocks.front().X.size();
  };
  for (const FieldName& field : drawn_fields)
    if (!run.fields.has(field.name) || !run.fields.has("x") || !std::ranges::all_of(run.fields.blocks, whole))
      throw FileError("cannot draw " + folder + ": its particles.csv or stress.csv is not whole");
  detail::TableLayout layout;
  for (const auto& column : detail::history_columns) layout.fields.emplace_back(column.name);
  detail::Table table(path / "history.csv", layout, faults, notes);
  const auto stop = [&] {
    if (const auto all = faults.messages(); !all.empty()) throw FileError("cannot draw " + all.front());
  };
  stop();
  for (detail::Row row; table.next(row);) {
    run.history["time"].push_back(row.key.time);
    for (std::size_t f = 0; f < layout.fields.size(); ++f)
      run.history[layout.fields[f]].push_back(table.value(row, f));
  }
  stop();
  run.probes = probes_of(run.scene, run.fields.blocks.front());
  return run;
}

/// What the exact solution is at the particles, and at the probes between the snapshots, too.
Exact exact_of(const Run& run, const ReferenceWatch& watch) {
  const std::optional<Reference> reference = make_reference(run.scene, watch);
  if (!reference) return {.reason = "no reference solution is known for this scene"};
  const bool rest = run.scene.rest.has_value();
  if (rest && run.time(run.last()) >= run.scene.end_time * (1.0 - 1e-9))
    return {.reason = "the body had not come to rest by the end time; the reference is the state of rest"};
  Exact exact;
  Values places;
  for (const std::size_t p : run.probes) places.push_back(run.fields.blocks.front().X[p]);
  exact.probes.resize(places.size());
  const std::size_t between = rest ? 0 : 1 + 200 / (run.last() + 1);
  for (std::size_t k = rest ? run.last() : 0; k <= run.last(); ++k) {  // times must not decrease
    Exact more;
    for (std::size_t i = between; k > 0 && i-- > 0;) {
      const double part = static_cast<double>(i) / static_cast<double>(between);
      more.times.push_back(run.time(k) - (run.time(k) - run.time(k - 1)) * part);
      try {
        more.probes.push_back(reference->at(more.times.back(), places).displacement);
      } catch (const Error& error) {
        exact.reason = error.what();
        return exact;
      }
    }
    auto fields = detail::sound_fields(*reference, run.time(k), run.fields.blocks[k].X, exact.reason);
    if (!fields) return exact;
    exact.own_error = std::max(exact.own_error, reference->estimated_error().displacement);
    exact.particles[k] = std::move(*fields);
    exact.times.insert(exact.times.end(), more.times.begin(), more.times.end());
    for (const Values& there : more.probes)
      for (std::size_t p = 0; p < there.size(); ++p) exact.probes[p].push_back(there[p]);
  }
  return exact;
}

/// As far as --errors lets it.
Exact exact_in_time(const CommandLine& given, const Run& run, const std::string& folder) {
  double seconds = 0.0;
  if (const fs::path file = fs::path(folder) / "timing.json"; fs::exists(file)) {
    const auto timing = nlohmann::json::parse(read_file(file.string()), nullptr, false);
    if (timing.is_object()) seconds = timing.value("seconds", 0.0);
  }
  Exact exact;
  std::string reason;
  if (!within_budget(errors_asked_for(given), seconds, given.has("quiet"), reason,
                     [&](const ReferenceWatch& watch) { exact = exact_of(run, watch); }))
    return {.reason = reason};
  return exact;
}

std::vector<Run> read_runs(const std::vector<std::string>& folders) {
  std::vector<Run> runs;
  std::map<std::string, int> labels, schemes;
  for (const std::string& folder : folders) {
    runs.push_back(read_run(folder));
    ++labels[runs.back().label];
  }
  for (std::size_t r = 0; r < runs.size(); ++r) {
    if (labels[runs[r].label] > 1) runs[r].label = folders[r];
    const std::string& scheme = runs[r].scene.scheme.name;
    // Further runs of a scheme are darker, lighter.
    constexpr double parts[] = {0.0, 0.5, -0.5};
    runs[r].colour = gnuplot::shade(gnuplot::scheme_stroke(scheme).colour, parts[schemes[scheme]++ % 3]);
    const auto without_scheme = [&](Scene scene) {
      scene.scheme = runs[0].scene.scheme;
      scene.output = runs[0].scene.output;
      for (std::size_t b = 0; b < scene.bodies.size() && b < runs[0].scene.bodies.size(); ++b)
        scene.bodies[b].scheme = runs[0].scene.bodies[b].scheme;
      return scene_text(scene);
    };
    const std::string mine = without_scheme(runs[r].scene), theirs = without_scheme(runs[0].scene);
    if (mine != theirs)
      throw UsageError(folders[r] + ": a run of another scene than " + folders[0] + ": " +
                       first_different_line(mine, theirs));
  }
  return runs;
}

/// The snapshot of a run at the time (s); nothing where none is near.
std::optional<std::size_t> snapshot_at(const Run& run, double time) {
  for (std::size_t k = 0; k <= run.last(); ++k)
    if (std::abs(run.time(k) - time) <= 0.005 * run.time(run.last())) return k;
  return std::nullopt;
}

/// Of so many particles which are drawn: one in an odd number passes through all places in a cell.
std::size_t every_of(std::size_t particles) { return (particles / 1000) | 1; }

const Stroke exact_line{.colour = "#000000", .width = 0.8};

std::string at_time(double time) { return "t = " + gnuplot::readable(time, "s"); }

/// A field over X at one time or, of a single run, several.
Panel profile(const std::vector<Run>& runs, const FieldName& field, const Values& times) {
  const bool single = runs.size() == 1;
  Panel panel{.title = field.name, .x = {"X", "m"}, .y = {field.symbol, field.unit}};
  if (!single) panel.title += ", " + at_time(times[0]);
  for (std::size_t t = 0; t < times.size(); ++t)
    for (const Run& run : runs) {
      const auto k = snapshot_at(run, times[t]);
      if (!k) continue;
      const double part = times.size() == 1
                              ? 0.0
                              : 1.2 * static_cast<double>(t) / static_cast<double>(times.size() - 1) - 0.6;
      const std::string colour = gnuplot::shade(run.colour, part);
      panel.curves.push_back(
          {single ? at_time(times[t]) : run.label, {.colour = colour, .size = 0.2}, {}, {}});
      const Values& values = run.values(field.name, *k);
      const std::size_t every = every_of(values.size());
      for (std::size_t p = 0; p < values.size(); p += every) {
        panel.curves.back().x.push_back(run.fields.blocks[*k].X[p]);
        panel.curves.back().y.push_back(values[p]);
      }
    }
  for (const double time : times)
    if (const auto k = snapshot_at(runs[0], time); k && runs[0].exact.particles.count(*k) > 0)
      panel.curves.push_back(
          {"exact", exact_line, runs[0].fields.blocks[*k].X, runs[0].exact.particles.at(*k).*field.exact});
  return panel;
}

/// Positions of the ends of several bodies, or the displacement of those of one that move.
Panel ends(const std::vector<Run>& runs) {
  const bool several = !runs[0].scene.bodies.empty();
  const auto& start = runs[0].fields.blocks.front();
  Panel panel{.title = "ends of the bodies", .x = {"t", "s"}, .y = {several ? "x" : "u", "m"}};
  if (!several) panel.title = "at X = ";
  for (const std::size_t p : runs[0].probes)
    if (!several) panel.title += (p == runs[0].probes[0] ? "" : ", ") + gnuplot::readable(start.X[p], "m");
  for (const Run& run : runs)
    for (std::size_t i = 0; i < run.probes.size(); ++i) {
      const std::size_t p = run.probes[i];
      const bool exact = i < run.exact.probes.size() && !run.exact.times.empty();
      Curve curve{"", {.colour = run.colour, .width = exact ? 0.0 : 1.2, .size = 0.3}, {}, {}};
      for (std::size_t k = 0; k <= run.last(); ++k) {
        curve.x.push_back(run.time(k));
        curve.y.push_back(run.values(several ? "x" : "displacement", k)[p]);
      }
      panel.curves.push_back(std::move(curve));
      if (exact && &run == &runs[0])
        panel.curves.push_back({"", exact_line, run.exact.times, run.exact.probes[i]});
    }
  return panel;
}

/// All energies of one run and what they add up to, or that of each of several.
Panel energy(const std::vector<Run>& runs) {
  const bool single = runs.size() == 1;
  Panel panel{.title = single ? "energies" : "kinetic and stored energy",
              .x = {"t", "s"},
              .y = {"E", "J/m²"},
              .own_legend = single};
  for (const Run& run : runs) {
    const Values& times = run.history.at("time");
    Curve sum{single ? "balance" : "", {.colour = run.colour, .width = 1.2}, times, Values(times.size())};
    if (single) sum.stroke = {.colour = "#BBBBBB", .width = 3.0};
    for (const std::string name : energies) {
      const Values& values = run.history.at(name);
      const bool work = name == "external_work";
      for (std::size_t i = 0; i < values.size() && (single || name == "kinetic" || name == "stored"); ++i)
        sum.y[i] += work ? -values[i] : values[i];
      if (!single || std::ranges::all_of(values, [](double e) { return e == 0.0; })) continue;
      const int drawn = static_cast<int>(panel.curves.size());
      const Stroke stroke{.colour = drawn < 3 ? "#000000" : "#808080", .dash = drawn % 3 + 1, .width = 1.2};
      panel.curves.push_back({work ? "work" : name, stroke, times, values});
    }
    panel.curves.insert(panel.curves.begin(), std::move(sum));  // below the others
  }
  return panel;
}

/// The error of the fields over time, over the largest norm of each.
Panel errors(const std::vector<Run>& runs, std::span<const FieldName> fields) {
  const bool single = runs.size() == 1;
  Panel panel{.title = single ? "errors" : std::string("error, ") + fields[0].name,
              .x = {"t", "s"},
              .y = {"rms / largest rms"},
              .logarithmic = true,
              .own_legend = single};
  double least = HUGE_VAL;
  for (const Run& run : runs)
    for (const FieldName& field : fields) {
      const int number = single ? static_cast<int>(&field - &fields[0]) : 0;
      Curve curve{
          single ? field.symbol : "",
          {.colour = run.colour, .dash = number + 1, .shape = 7 - 3 * number, .width = 1.2, .size = 0.4},
          {},
          {}};
      double largest = 0.0;
      for (const auto& [k, exact] : run.exact.particles) {
        const Values& truth = exact.*field.exact;
        curve.x.push_back(run.time(k));
        curve.y.push_back(error_norms(run.values(field.name, k), truth).rms);
        largest = std::max(largest, error_norms(truth, Values(truth.size())).rms);
      }
      if (!(largest > 0.0)) continue;
      for (double& error : curve.y) {
        error /= largest;
        if (error > 0.0) least = std::min(least, error);
      }
      panel.curves.push_back(std::move(curve));
    }
  const Exact& exact = runs[0].exact;
  if (exact.own_error > 0.1 * least)
    panel.curves.push_back({single ? "reference" : "",
                            {.colour = "#808080", .dash = 3, .width = 1.2},
                            {0.0, runs[0].time(runs[0].last())},
                            {exact.own_error, exact.own_error}});
  panel.note = exact.reason.empty() ? "the exact fields are zero" : exact.reason;
  if (!exact.reason.empty() && !exact.particles.empty())
    panel.title += ", known to " + at_time(runs[0].time(exact.particles.rbegin()->first));
  return panel;
}

std::string title_of(const std::vector<Run>& runs) {
  const Scene& scene = runs[0].scene;
  std::string title = scene.case_name + (scene.variant.empty() ? "" : " " + scene.variant);
  if (runs.size() == 1)
    title +=
        ": " + runs[0].label + ", " + std::to_string(runs[0].fields.blocks.front().X.size()) + " particles";
  return title;
}

gnuplot::Picture page(const std::vector<Run>& runs, const Values& times) {
  gnuplot::Picture picture{.title = title_of(runs)};
  const auto row = [&](const Values& at) {
    for (const FieldName& field : drawn_fields) picture.panels.push_back(profile(runs, field, at));
  };
  if (runs.size() == 1) {
    row(times);
  } else {
    for (const double time : times) row({time});
    for (const FieldName& field : drawn_fields) picture.panels.push_back(errors(runs, {&field, 1}));
  }
  picture.panels.push_back(ends(runs));
  picture.panels.push_back(energy(runs));
  if (runs.size() == 1) picture.panels.push_back(errors(runs, drawn_fields));
  return picture;
}

/// Stress and velocity over X and time, in colours; a row for each run.
gnuplot::Picture space_time(const std::vector<Run>& runs) {
  gnuplot::Picture picture{.title = title_of(runs), .columns = 2, .panel_width = 321, .panel_height = 290};
  for (const Run& run : runs)
    for (const FieldName& field : {drawn_fields[2], drawn_fields[1]}) {
      Panel panel{
          .title = std::string(field.name), .x = {"X", "m"}, .y = {"t", "s"}, .image_unit = field.unit};
      if (runs.size() > 1) panel.title = run.label + ": " + panel.title;
      const auto& start = run.fields.blocks.front();
      const std::size_t n = start.X.size();
      const std::size_t every = every_of(n);
      for (std::size_t first = 0, end = 0; first < n; first = end) {  // a body: its particles lie evenly
        end = first + 1;
        while (end < n && (start.body.empty() || start.body[end] == start.body[first])) ++end;
        gnuplot::Image image{start.X[first], 1.0, 0.0, 1.0, (end - first + every - 1) / every, {}};
        if (end - first > 1) image.dx = (start.X[first + 1] - start.X[first]) * static_cast<double>(every);
        // The last one of a run that came to rest is early.
        if (const auto k = std::max(run.last(), std::size_t{2}) - 1; run.last() > 0)
          image.dy = run.time(k) / static_cast<double>(k);
        for (std::size_t k = 0; k <= run.last(); ++k)
          for (std::size_t p = first; p < end; p += every)
            image.values.push_back(run.values(field.name, k)[p]);
        panel.images.push_back(std::move(image));
      }
      picture.panels.push_back(std::move(panel));
    }
  return picture;
}

}  // namespace

void check_picture_options(const CommandLine& given) {
  for (const char* option : {"picture", "picture-xt"})
    if (given.has(option)) require_picture_name(std::string("--") + option, given.text(option));
  if (given.arguments.empty()) return;
  const std::string& first = given.arguments.front();
  if (!given.has("picture") && !given.has("picture-xt")) throw UsageError("`" + first + "` is not an option");
  for (const auto& [name, value] : given.options)
    if (name != "picture" && name != "picture-xt" && name != "errors" && name != "quiet" &&
        name != "other arguments")
      throw UsageError(std::string("--").append(name).append(" is about a new run, and `").append(first) +
                       "` one that is there: draw one or the other");
}

bool draw_runs(const CommandLine& given, const std::vector<std::string>& folders) {
  std::vector<Run> runs = read_runs(folders);
  bool drawn = true;
  const auto put = [&](const gnuplot::Picture& picture, const std::string& file) {
    const std::string obstacle = draw(picture, file);
    if (obstacle.empty()) return;
    std::cerr << "hompm-run: no picture: " << obstacle << '\n';
    drawn = false;
  };
  if (given.has("picture")) {
    Values times;
    const std::size_t last = runs[0].last();
    const std::size_t count = std::clamp<std::size_t>(last, 1, runs.size() == 1 ? 3 : 2);
    for (std::size_t i = 1; i <= count; ++i) times.push_back(runs[0].time(last * i / count));
    for (std::size_t r = 0; r < runs.size(); ++r) runs[r].exact = exact_in_time(given, runs[r], folders[r]);
    put(page(runs, times), given.text("picture"));
  }
  if (given.has("picture-xt")) put(space_time(runs), given.text("picture-xt"));
  return drawn;
}

}  // namespace hompm::cli
