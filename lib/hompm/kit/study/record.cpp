#include <array>
#include <utility>

#include <nlohmann/json.hpp>

#include <hompm/kit/output/staging.hpp>
#include <hompm/kit/study/record.hpp>

namespace hompm::study {
namespace {

using Json = nlohmann::ordered_json;

constexpr std::array<std::pair<Status, const char*>, 4> status_names{{{Status::ok, "ok"},
                                                                      {Status::refused, "refused"},
                                                                      {Status::invalid, "invalid"},
                                                                      {Status::unjudged, "unjudged"}}};

Status status_of(const std::string& name) {
  for (const auto& [status, known] : status_names)
    if (name == known) return status;
  throw Error("no status is called " + name);
}

Json json_of(const ErrorNorms& norms, double own) {
  return {
      {"relative_l2", norms.relative_l2}, {"rms", norms.rms}, {"max", norms.max}, {"reference_error", own}};
}

void read_norms(const Json& json, ErrorNorms& norms, double& own) {
  norms = {json.at("relative_l2"), json.at("rms"), json.at("max")};
  own = json.at("reference_error");
}

/// What `read` makes of the JSON text; a missing or misshapen part is an `Error`.
template <class Read>
auto read_json(const std::string& text, Read read) {
  try {
    return read(Json::parse(text));
  } catch (const Json::exception& error) {
    throw Error(std::string("not a record of a study: ") + error.what());
  }
}

}  // namespace

std::string to_string(Status status) { return status_names[static_cast<std::size_t>(status)].second; }

Instructions extrapolated(std::uint64_t counted, std::int64_t counted_steps, const Work& work) {
  const auto few = static_cast<std::uint64_t>(counted_steps);
  const auto all = static_cast<std::uint64_t>(work.steps);
  // Whole and rest apart, so that the product cannot overflow.
  const std::uint64_t total = counted / few * all + counted % few * all / few;
  const double per_step = static_cast<double>(counted) / static_cast<double>(few);
  return {counted, counted_steps, total, per_step / static_cast<double>(work.particles)};
}

std::string record_text(const Record& record) {
  Json json{{"name", record.name},
            {"status", to_string(record.status)},
            {"reason", record.reason},
            {"scheme", record.scheme},
            {"degree", record.degree},
            {"cells", record.cells},
            {"particles_per_cell", record.particles_per_cell},
            {"time_step", record.time_step},
            {"work",
             {{"particles", record.work.particles},
              {"steps", record.work.steps},
              {"force_evaluations", record.work.force_evaluations},
              {"mass_solves", record.work.mass_solves},
              {"bytes", record.work.bytes}}},
            {"errors", nullptr},
            {"instructions", nullptr},
            {"program", record.program},
            {"scene", record.scene}};
  if (const auto& errors = record.errors) {
    json["errors"] = {{"reference", errors->reference}};
    for (const ErrorField& field : error_fields)
      json["errors"][field.name] = json_of((*errors).*field.norms, errors->reference_errors.*field.error);
  }
  if (const auto& count = record.instructions)
    json["instructions"] = {{"total", count->total},
                            {"per_particle_and_step", count->per_particle_and_step},
                            {"counted", count->counted},
                            {"counted_steps", count->counted_steps}};
  return json.dump(2) + "\n";
}

Record read_record(const std::string& text) {
  return read_json(text, [](const Json& json) {
    Record record;
    record.name = json.at("name");
    record.status = status_of(json.at("status"));
    record.reason = json.at("reason");
    record.scheme = json.at("scheme");
    record.degree = json.at("degree");
    record.cells = json.at("cells");
    record.particles_per_cell = json.at("particles_per_cell");
    record.time_step = json.at("time_step");
    const Json& work = json.at("work");
    record.work = {work.at("particles"), work.at("steps"), work.at("force_evaluations"),
                   work.at("mass_solves"), work.at("bytes")};
    record.program = json.at("program");
    record.scene = json.at("scene");
    if (const Json& errors = json.at("errors"); !errors.is_null()) {
      ErrorReport& report = record.errors.emplace();
      report.reference = errors.at("reference");
      for (const ErrorField& field : error_fields)
        read_norms(errors.at(field.name), report.*field.norms, report.reference_errors.*field.error);
    }
    if (const Json& count = json.at("instructions"); !count.is_null())
      record.instructions = Instructions{count.at("counted"), count.at("counted_steps"), count.at("total"),
                                         count.at("per_particle_and_step")};
    return record;
  });
}

std::string times_text(const Times& times) {
  return Json{{"name", times.name},
              {"seconds", times.seconds},
              {"program", times.program},
              {"scene", times.scene}}
             .dump(2) +
         "\n";
}

Times read_times(const std::string& text) {
  return read_json(text, [](const Json& json) {
    return Times{json.at("name"), json.at("program"), json.at("scene"), json.at("seconds")};
  });
}

std::filesystem::path record_path(const std::filesystem::path& folder, const std::string& name) {
  return folder / "points" / (name + ".json");
}

std::filesystem::path times_path(const std::filesystem::path& folder, const std::string& name) {
  return folder / "times" / (name + ".json");
}

std::optional<std::string> text_of(const std::filesystem::path& path) {
  std::error_code none;
  if (!std::filesystem::exists(path, none)) return std::nullopt;
  return read_file(path);
}

}  // namespace hompm::study
