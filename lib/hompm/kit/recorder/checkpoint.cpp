#include <string_view>
#include <utility>

#include <hompm/build_info.hpp>
#include <hompm/kit/recorder/bytes.hpp>
#include <hompm/kit/recorder/checkpoint.hpp>
#include <hompm/kit/scene_file/reader.hpp>

namespace hompm {
namespace {

using detail::ByteReader;
using detail::ByteWriter;

constexpr std::string_view magic = "hompm checkpoint";
constexpr std::size_t head_size = magic.size() + 24;  // magic, format, length, hash

/// The sums of a point, in the order in which they are written; `Any` is a `RunPoint`, const or not.
template <class Any, class Visit>
void visit_sums(Any& point, Visit visit) {
  // Every member is named, so that a new one does not compile before it has its place here.
  auto& [states, extremes, supplied, quiet_steps] = point;
  auto& [residual, momentum_residual, internal_force_sum, energy, momentum, step_fraction, wave_speed, strain,
         dissipated] = extremes;
  visit(residual);
  visit(momentum_residual);
  visit(internal_force_sum);
  visit(energy);
  visit(momentum);
  visit(step_fraction);
  visit(wave_speed);
  visit(strain);
  visit(dissipated);
  visit(supplied);
}

std::string identity() { return build_info().version + " (" + build_info().commit + ")"; }

/// Of each particle that is reported.
std::vector<std::int64_t> body_numbers(const std::vector<State>& states) {
  std::vector<std::int64_t> numbers;
  for (std::size_t body = 0; body < states.size(); ++body) {
    const Particles& p = states[body].particles;
    numbers.resize(numbers.size() + p.size() - 2 * p.markers, static_cast<std::int64_t>(body));
  }
  return numbers;
}

void write_records(ByteWriter& out, const Checkpoint& checkpoint) {
  out.word(checkpoint.history.size());
  for (const HistoryRow& row : checkpoint.history) {
    out.number(row.time);
    for (const auto& column : detail::history_columns) out.number(row.*column.value);
  }
  out.text(checkpoint.probes);
  out.word(checkpoint.snapshots.size());
  for (const Snapshot& snapshot : checkpoint.snapshots) {
    out.number(snapshot.time);
    out.word(snapshot.size());
    for (const auto& column : detail::all_columns)
      for (const double value : snapshot.*column.values) out.number(value);
    out.word(snapshot.reported.size());
    for (const ReportedField& field : snapshot.reported) {
      out.text(field.name);
      out.text(field.unit);
      for (const double value : field.values) out.number(value);
    }
  }
}

void read_records(ByteReader& in, Checkpoint& checkpoint) {
  const std::vector<std::int64_t> bodies = body_numbers(checkpoint.point.states);
  checkpoint.history.resize(in.count(8 * (1 + detail::history_columns.size())));
  for (HistoryRow& row : checkpoint.history) {
    row.time = in.number();
    for (const auto& column : detail::history_columns) row.*column.value = in.number();
  }
  checkpoint.probes = in.text();
  checkpoint.snapshots.resize(in.count(16 + 8 * detail::all_columns.size() * bodies.size()));
  for (Snapshot& snapshot : checkpoint.snapshots) {
    snapshot.time = in.number();
    if (in.word() != bodies.size()) throw Error("a snapshot in it does not fit its scene");
    const auto read = [&](std::vector<double>& values) {
      values.resize(bodies.size());
      for (double& value : values) value = in.number();
    };
    for (const auto& column : detail::all_columns) read(snapshot.*column.values);
    snapshot.reported.resize(in.count(16));
    for (ReportedField& field : snapshot.reported) {
      field.name = in.text();
      field.unit = in.text();
      read(field.values);
    }
    if (!checkpoint.scene.bodies.empty()) snapshot.body = bodies;
  }
}

void write_point(ByteWriter& out, const RunPoint& point) {
  visit_sums(point, [&](double value) { out.number(value); });
  out.word(detail::word_of(point.quiet_steps));
  for (const State& state : point.states) detail::write_state(out, state);
}

/// Throws `Error` when a field is not what the scene makes it.
void read_point(ByteReader& in, RunPoint& point) {
  visit_sums(point, [&](double& value) { value = in.number(); });
  detail::read_value(in, point.quiet_steps);
  for (State& state : point.states) detail::read_state(in, state);
}

/// The state of a scene takes memory: no more than what follows can fill.
void check_room(const Scene& scene, std::size_t bytes) {
  std::int64_t values = 0;
  for (const Scene* body : bodies_of(scene))
    values += std::int64_t{body->scheme.cells} * (std::int64_t{body->scheme.particles_per_cell} + 1) +
              body->scheme.margin_cells;
  if (static_cast<std::uint64_t>(values) > bytes / 8) throw detail::BytesEnd();
}

Checkpoint read_content(std::string_view bytes, const std::string& source, const EffectCatalogue& effects) {
  ByteReader in(bytes);
  if (const std::string writer = in.text(); writer != identity())
    throw Error("it was written by hompm " + writer + ", and this is " + identity() +
                ": the result would be that of neither");
  const Scene scene = parse_scene(in.text(), "scene in " + source, {}, effects);
  check_room(scene, in.left());
  Checkpoint checkpoint = first_checkpoint(scene);
  detail::read_value(in, checkpoint.every);
  checkpoint.vtk = in.word() != 0;
  checkpoint.keep = in.word() != 0;
  checkpoint.errors = in.text();
  checkpoint.seconds = in.number();
  read_records(in, checkpoint);
  read_point(in, checkpoint.point);
  if (in.left() > 0) throw Error("there is more in it than a checkpoint");
  return checkpoint;
}

}  // namespace

Checkpoint first_checkpoint(const Scene& scene) {
  return {.scene = scene,
          .history = {},
          .snapshots = {},
          .probes = {},
          .point = {Simulation(scene, 0.0).states()}};
}

std::string checkpoint_bytes(const Checkpoint& checkpoint) {
  ByteWriter rest;
  rest.text(identity());
  rest.text(scene_text(checkpoint.scene));
  rest.word(detail::word_of(checkpoint.every));
  rest.word(checkpoint.vtk ? 1 : 0);
  rest.word(checkpoint.keep ? 1 : 0);
  rest.text(checkpoint.errors);
  rest.number(checkpoint.seconds);
  write_records(rest, checkpoint);
  write_point(rest, checkpoint.point);

  ByteWriter head;
  head.bytes = magic;
  head.word(checkpoint_format);
  head.word(rest.bytes.size());
  head.word(detail::hash_of_bytes(rest.bytes));
  return head.bytes + rest.bytes;
}

Checkpoint parse_checkpoint(const std::string& bytes, const std::string& source,
                            const EffectCatalogue& effects) {
  const auto refuse = [&](const std::string& reason) {
    throw CheckpointError("cannot resume from " + source + ": " + reason);
  };
  const std::string_view all = bytes;
  if (all.substr(0, magic.size()) != magic.substr(0, all.size()) || all.empty())
    refuse("it is not a checkpoint of hompm");
  if (all.size() < head_size) refuse("it is cut short, after " + std::to_string(all.size()) + " bytes");
  ByteReader head(all.substr(magic.size()));
  if (const auto found = head.word(); found != checkpoint_format)
    refuse("it has the format " + std::to_string(found) + ", and this hompm reads " +
           std::to_string(checkpoint_format));
  const auto length = head.word();
  const auto hash = head.word();
  const std::string_view rest = all.substr(head_size);
  if (rest.size() < length)
    refuse("it is cut short: " + std::to_string(rest.size()) + " bytes of " + std::to_string(length));
  if (rest.size() > length) refuse("it is damaged: it is longer than it says");
  if (detail::hash_of_bytes(rest) != hash) refuse("it is damaged: its checksum does not match");
  try {
    return read_content(rest, source, effects);
  } catch (const Error& error) {
    throw CheckpointError("cannot resume from " + source + ": " + error.what());
  }
}

std::filesystem::path checkpoint_folder(const std::filesystem::path& path) {
  std::error_code ignored;
  if (std::filesystem::is_directory(path, ignored)) return path;
  return path.has_parent_path() ? path.parent_path() : ".";
}

Checkpoint read_checkpoint(const std::filesystem::path& path, const EffectCatalogue& effects) {
  const auto folder = checkpoint_folder(path);
  const auto file = folder == path ? path / checkpoint_name : path;
  std::error_code ignored;
  if (!std::filesystem::exists(file, ignored) && std::filesystem::exists(folder / "run.json", ignored))
    throw CheckpointError("cannot resume from " + path.string() +
                          ": there is no checkpoint, and the run in " + folder.string() + " is complete");
  return parse_checkpoint(read_file(file), path.string(), effects);
}

CheckpointWriter::CheckpointWriter(RunFolder& folder, Checkpoint checkpoint,
                                   std::function<void(const std::string&)> warn)
    : folder_(folder),
      checkpoint_(std::move(checkpoint)),
      warn_(std::move(warn)),
      written_(checkpoint_.point.states.front().step) {}

void CheckpointWriter::write(const RunPoint& point, double seconds) {
  checkpoint_.point = point;
  checkpoint_.seconds = seconds;
  try {
    folder_.write_checkpoint(checkpoint_bytes(checkpoint_));
    written_ = point.states.front().step;
    failing_ = false;
  } catch (const FileError& error) {
    if (!failing_)
      warn_("no checkpoint at step " + std::to_string(point.states.front().step) + ": " + error.what() +
            "; the run goes on, " +
            (written_ > 0 ? "the last checkpoint is of step " + std::to_string(written_)
                          : std::string("there is none of it yet")));
    failing_ = true;
  }
}

}  // namespace hompm
