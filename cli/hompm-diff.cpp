// hompm-diff: exact comparison of two run folders, and comparison of another code's results with one.
//
// Description:
//   Compares particles.csv, stress.csv and history.csv of folder A with those of folder B, bit for bit, and
//   scene.toml as text. Tolerances have to be asked for, field by field or for `all` of them. Says where the
//   two differ first and where each field differs most. The exit code tells the verdict: 0 identical or
//   equivalent, 3 different. Where A is a file, see diff_options.hpp.

#include <algorithm>
#include <filesystem>
#include <iostream>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include <hompm/kit/output/staging.hpp>
#include <hompm/kit/recorder/trace_file.hpp>

#include "child.hpp"
#include "diff_options.hpp"
#include "findings.hpp"
#include "foreign_formats.hpp"
#include "foreign_picture.hpp"
#include "interruption.hpp"

namespace hompm::cli {
namespace {

Tool this_tool() {
  return {
      .name = "hompm-diff",
      .usage = "[options] A B",
      .about =
          "Compares the results in the folder A with those in the golden folder B, bit for bit; "
          "or those of another code in the file A (- for standard input) with those in B and the exact "
          "solution; B may then be a scene file or a built-in case, too.",
      .examples = {"hompm-diff out golden/bar-large-bspline",
                   "hompm-diff --relative all=1e-2 mine.csv golden/bar-small-bspline"},
      .topics = {{"bounds",
                  "what may differ; FIELD is a column of a CSV file, or `all`: every field without a bound "
                  "of its own",
                  {"hompm-diff --relative stress=1e-9 out golden/bar-large-bspline",
                   "hompm-diff --ulps all=4 out golden/bar-large-bspline"},
                  {{"absolute", "FIELD=T...", "values of FIELD may differ by T, in its unit"},
                   {"relative", "FIELD=T...", "… by T times the largest value of FIELD at that time in B"},
                   {"ulps", "FIELD=N...", "… by N units in the last place"}}},
                 {"csv",
                  "when A is a file of another code",
                  {"hompm-diff --exact all=2e-2 --time 2.5 mine.csv golden/bar-small-bspline",
                   "hompm-diff --picture mine.svg mine.csv golden/bar-small-bspline"},
                  foreign_options()},
                 {"traces",
                  "where two runs part",
                  {"hompm-diff --trace mine.trace theirs.trace", "hompm-diff --trace mine.trace"},
                  {{"trace", "",
                    "A and B are files of hompm-run --trace: say where the runs part; A alone is printed"}}},
                 {"outputs", "what is printed", {}, {{"quiet", "", "nothing; only the exit code tells"}}}},
      .remarks =
          "A value passes when it meets any of its bounds. Without bounds a single bit\n"
          "makes the two different. A file of another code is a table, .vtu, .vtp, .pvd or\n"
          "LAMMPS dump, maybe in .gz; it needs X, time and one of x, displacement,\n"
          "velocity, volume, density, stress, stretch, in any order. Particles are matched\n"
          "by X.\n"
          "Largest values are then those of all times, and only fields with a bound are\n"
          "judged, if any has one; with `all` each field of B must be there.\n\n"
          "Exit codes: 0 identical or equivalent, 2 bad usage, 3 different, 5 cannot read\n"
          "or write.\n",
      .takes_arguments = true};
}

template <class Found>
void print(const CommandLine& given, const Found& found) {
  if (given.has("json"))
    std::cout << json_of(found, given.arguments[0], given.arguments[1]);
  else if (!given.has("quiet"))
    std::cout << text_of(found);
}

/// Which variant of the scheme A agrees with.
void tell_variants(const CommandLine& given, const std::filesystem::path& table, const std::string& a,
                   const std::string& b, const ForeignOptions& options) {
  given.refuse({"absolute", "relative", "ulps", "exact", "time", "time-tolerance", "fields", "interpolate",
                "submit", "picture"},
               "--which tells digits at all times of A: it takes no");
  SchemeVariants variants;
  {
    ProgressBar bar(given.has("quiet"), "variants");
    variants = scheme_variants(table, b, options, [&](auto done, auto all) { bar.update(done, all); });
  }
  if (given.has("json"))
    std::cout << json_of(variants, a, b);
  else if (!given.has("quiet"))
    std::cout << text_of(variants, a, b);
}

/// A new folder for golden/others: the table, and what its author has to say of it, to be filled in.
void submit(const std::string& folder, const std::filesystem::path& table, const std::filesystem::path& b) {
  std::error_code none;
  if (std::filesystem::exists(folder, none)) throw UsageError("--submit " + folder + ": it is there already");
  const bool results = std::filesystem::is_directory(b, none);
  const std::string name = (results ? (b / "").parent_path() : b).filename().string();
  nlohmann::ordered_json code;
  for (const char* word : {"code", "authors", "version", "language", "settings", "machine", "ran_by"})
    code[word] = "";
  code["results"] = {
      {{"file", "results.csv"},
       {"case", name},
       {"run", results ? "--scene golden/" + name + "/scene.toml --snapshots 2" : "--scene " + b.string()},
       {"ns_per_particle_and_step", nullptr}}};
  detail::StagingFolder made(folder);
  made.replace("results.csv", read_file(table));
  made.replace("code.json",
               code.dump(2, ' ', false, nlohmann::ordered_json::error_handler_t::replace) + "\n");
}

/// Of a file of another code.
Verdict compare_file(const CommandLine& given, const std::string& file, const std::string& folder) {
  ForeignOptions options = read_foreign_options(given);
  options.name = file == "-" ? "standard input" : file;
  const std::string picture = given.text("picture");
  if (given.has("picture")) require_picture_name("--picture", picture);
  try {
    const TableFile table(file, options.direction, seconds(given, "time-step"));
    if (given.has("which")) {
      tell_variants(given, table.path(), file, folder, options);
      return Verdict::identical;
    }
    const ForeignComparison found = compare_foreign(table.path(), folder, options);
    if (given.has("submit")) submit(given.text("submit"), table.path(), folder);
    print(given, found);
    const std::string obstacle =
        given.has("picture") ? draw_picture(found, options.name, folder, picture) : "";
    if (!obstacle.empty()) std::cerr << "hompm-diff: no picture: " << obstacle << '\n';
    return found.verdict;
  } catch (const OptionError& error) {
    throw UsageError(error.what());
  }
}

/// One trace alone: what each stage of each step changed.
void print_trace(const std::string& path) {
  detail::TraceFile file(path, path);
  std::cout << "by " << file.build << ", from step " << file.first_step << " on"
            << (file.complete() ? "" : "; it has no end: the run was cut off, or still goes on") << '\n';
  std::int64_t step = -1;
  int part = 0;
  while (const auto entry = file.next()) {
    if (step != entry->step || part != entry->part)
      std::cout << "step " << entry->step
                << (entry->part > 1 ? ", part " + std::to_string(entry->part) : std::string()) << '\n';
    step = entry->step;
    part = entry->part;
    file.take();
    const detail::TraceField& field = file.fields[entry->field];
    const std::string body = file.fields.back().body > 0 ? " of body " + std::to_string(field.body) : "";
    std::cout << "  " << padded(file.stages[entry->stage].name, 34) << padded(field.name + body, 30) << "0x"
              << hex(field.hash);
    if (!field.values.empty() && !field.is_integer) {
      std::vector<double> values(field.size);
      detail::ByteReader in(field.values);
      for (double& value : values) value = in.number();
      const auto [least, most] = std::ranges::minmax_element(values);
      std::cout << "  " << rounded(*least) << " ... " << rounded(*most);
    }
    std::cout << '\n';
  }
}

Verdict compare(const CommandLine& given) {
  const auto& names = given.arguments;
  if (given.has("trace") && names.size() == 1) {
    given.refuse({"absolute", "relative", "ulps", "json", "quiet"},
                 "--trace of one file prints it: it takes no");
    refuse_foreign_options(given);
    print_trace(names[0]);
    return Verdict::identical;
  }
  if (names.size() != 2)
    throw UsageError("A and B to compare are needed, not " + std::to_string(names.size()));
  if (given.has("quiet") && given.has("json")) throw UsageError("--quiet and --json contradict each other");
  std::error_code missing;  // then it is nothing, and reading it says why
  const auto is_folder = [&](const std::string& name) {
    return std::filesystem::is_directory(name, missing);
  };
  if (!given.has("trace") && !is_folder(names[0])) return compare_file(given, names[0], names[1]);
  if (given.has("trace"))
    given.refuse({"absolute", "relative", "ulps"}, "--trace compares bits: it takes no");
  refuse_foreign_options(given);
  if (given.has("trace")) {
    const TraceComparison found = compare_traces(names[0], names[1]);
    print(given, found);
    return found.identical ? Verdict::identical : Verdict::different;
  }
  if (std::filesystem::exists(names[1], missing) && !is_folder(names[1]))
    throw UsageError(names[1] + " is a file, " + names[0] +
                     " a folder: a file of another code comes first, what it is held against second");
  Comparison found = compare_folders(names[0], names[1], read_tolerances(given, compared_fields()));
  compare_scenes(names[0], names[1], found);
  print(given, found);
  return found.verdict;
}

}  // namespace
}  // namespace hompm::cli

int main(int argc, char** argv) {
  using namespace hompm::cli;
  return run_tool(this_tool(), argc, argv, [](const CommandLine& given) {
    return compare(given) == hompm::Verdict::different ? different : success;
  });
}
