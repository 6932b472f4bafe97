#include <cmath>
#include <span>
#include <string_view>
#include <utility>

#include <hompm/build_info.hpp>
#include <hompm/kit/output/text_file.hpp>
#include <hompm/kit/recorder/trace.hpp>
#include <hompm/kit/recorder/trace_file.hpp>
#include <hompm/kit/scene_file/reader.hpp>
#include <hompm/number.hpp>

namespace hompm {
namespace {

constexpr std::size_t chunk = 1 << 16;  // bytes per write; whole words for the hash of the file
constexpr const char* beginning = "beginning of the step, or of a part of it";

struct StageName {
  std::string name;
  std::string called_by;
};

template <class Values>
std::uint64_t hash_of(const Values& values) {
  detail::Hash hash;
  for (const auto value : values) hash.add(detail::word_of(value));
  return hash.value();
}

}  // namespace

class Trace::Recorder {
 public:
  Recorder(const std::filesystem::path& path, const TraceOptions& options) : path_(path), options_(options) {}

  /// `stages` are those of all bodies and between them, in the order in which they run.
  void begin(const Scene& scene, const Simulation& simulation, std::span<const StageName> stages) {
    file_.emplace(path_, path_);
    states_ = simulation.states();
    step_ = states_.front().step;
    const BuildInfo& build = build_info();
    for (const State& state : states_) {
      first_field_.push_back(before_.size());
      visit_fields(state, [&](const FieldInfo&, auto values) {
        const auto bytes = std::as_bytes(values);
        before_.emplace_back(bytes.begin(), bytes.end());
      });
    }
    if (options_.table_steps > 0) return begin_table(stages);
    out_.bytes = detail::trace_magic;
    out_.word(detail::trace_format);
    out_.text("hompm " + build.version + " (" + build.commit + "), " + build.compiler + ", " +
              build.architecture);
    out_.text(scene_text(scene));
    out_.word(states_.front().particles.markers);
    out_.word(detail::word_of(step_));
    if (stages.size() + 1 >= detail::first_tag) throw Error("too many stages for a trace");
    out_.word(stages.size() + 1);
    out_.text(beginning);
    out_.text("");
    for (const auto& [name, called_by] : stages) {
      out_.text(name);
      out_.text(called_by);
    }
    out_.word(before_.size());
    for (std::size_t body = 0; body < states_.size(); ++body)
      visit_fields(states_[body], [&](const FieldInfo& info, auto values) {
        using Value = typename decltype(values)::value_type;
        out_.text(info.name);
        out_.word(body);
        out_.word(static_cast<std::uint64_t>(info.site));
        out_.word(std::is_integral_v<Value> ? 1 : 0);
        out_.word(values.size());
        out_.word(hash_of(values));
      });
    choose_values();
  }

  /// A step, or a part of one, begins; called more than once for each.
  void begin_part(std::size_t body, const State& state) {
    if (!is_run(body, state) || std::exchange(in_part_, true)) return;
    const bool anew = state.step != step_;
    step_ = state.step;
    part_ = anew ? 1 : part_ + 1;
    if (options_.table_steps == 0) {
      out_.word<2>(anew ? detail::next_step : detail::next_part);
      if (anew) choose_values();
    }
    for (std::size_t each = 0; each < states_.size(); ++each) record(0, each, states_[each]);
  }

  /// The last stage of a body is through.
  void end_part(std::size_t body, const State& state) {
    if (is_run(body, state) && body + 1 == states_.size()) in_part_ = false;
  }

  /// What `stage` changed in a body.
  void record(std::uint16_t stage, std::size_t body, const State& state) {
    if (!is_run(body, state) || (options_.table_steps > 0 && step_ > options_.table_steps)) return;
    std::size_t field = first_field_[body];
    visit_fields(state, [&](const FieldInfo& info, auto values) {
      const auto bytes = std::as_bytes(values);
      auto& before = before_[field];
      if (bytes.size() != before.size() || std::memcmp(bytes.data(), before.data(), bytes.size()) != 0) {
        before.assign(bytes.begin(), bytes.end());
        if (options_.table_steps > 0)
          add_rows(stage, body, info, values);
        else
          add_entry(stage, field, values);
      }
      ++field;
    });
    if (out_.bytes.size() >= chunk) flush(out_.bytes.size() / chunk * chunk);
  }

  void close() {
    if (!file_ || std::exchange(closed_, true)) return;
    if (options_.table_steps > 0) {
      flush(out_.bytes.size());
      return file_->close();
    }
    const std::uint64_t size = written_ + out_.bytes.size();
    detail::Hash hash = hash_;
    detail::add_bytes(hash, out_.bytes);
    hash.add(size);
    out_.word<2>(detail::trace_end);
    out_.word(hash.value());
    flush(out_.bytes.size());
    file_->close();
  }

 private:
  /// Not a copy, on which an output is computed.
  [[nodiscard]] bool is_run(std::size_t body, const State& state) const { return &state == &states_[body]; }

  template <class Values>
  void add_entry(std::uint16_t stage, std::size_t field, const Values& values) {
    out_.word<2>(stage);
    out_.word<2>(field);
    out_.word(hash_of(values));
    if (!with_values_) return;
    out_.word<2>(detail::entry_values);
    write_values(values);
  }

  void begin_table(std::span<const StageName> stages) {
    out_.bytes = "step,part,stage,body,field,index,value\n";
    stages_.push_back("beginning");
    for (const StageName& stage : stages) stages_.push_back(stage.name);
    stages_.push_back("start");
    for (std::size_t body = 0; body < states_.size(); ++body)
      visit_fields(states_[body], [&](const FieldInfo& info, auto values) {
        add_rows(stages_.size() - 1, body, info, values);
      });
  }

  template <class Values>
  void add_rows(std::size_t stage, std::size_t body, const FieldInfo& info, const Values& values) {
    const std::string front = std::to_string(step_) + "," + std::to_string(part_) + "," + stages_[stage] +
                              "," + std::to_string(body) + "," + std::string(info.name) + ",";
    for (std::size_t i = 0; i < values.size(); ++i)
      out_.bytes.append(front).append(std::to_string(i)).append(",").append(text_of(values[i])).append("\n");
    if (out_.bytes.size() >= chunk) flush(out_.bytes.size() / chunk * chunk);
  }

  template <class Value>
  static std::string text_of(Value value) {
    if constexpr (std::is_integral_v<Value>)
      return std::to_string(value);
    else
      return std::isfinite(value) ? to_text(value) : std::isnan(value) ? "nan" : value > 0.0 ? "inf" : "-inf";
  }

  /// Of the step that begins.
  void choose_values() {
    const bool before =
        std::exchange(with_values_, step_ >= options_.values_from && values_written_ < options_.values_bytes);
    if (!with_values_ || before) return;
    out_.word<2>(detail::all_values);
    for (const State& state : states_)
      visit_fields(state, [&](const FieldInfo&, auto values) { write_values(values); });
  }

  template <class Values>
  void write_values(const Values& values) {
    for (const auto value : values) out_.word(detail::word_of(value));
    values_written_ += 8 * values.size();
  }

  void flush(std::size_t size) {
    const std::string_view part = std::string_view(out_.bytes).substr(0, size);
    detail::add_bytes(hash_, part);
    try {
      *file_ << part;
    } catch (const FileError&) {
      remove();
      throw;
    }
    written_ += size;
    out_.bytes.erase(0, size);
  }

  /// What could not be written whole is not left behind; a pipe or a device is not ours to remove.
  void remove() {
    closed_ = true;
    std::error_code ignored;
    if (std::filesystem::is_regular_file(path_, ignored)) std::filesystem::remove(path_, ignored);
  }

  std::filesystem::path path_;
  std::optional<detail::TextFile> file_;
  TraceOptions options_;
  detail::ByteWriter out_;
  detail::Hash hash_;
  std::uint64_t written_ = 0;
  std::size_t values_written_ = 0;
  std::span<const State> states_;               ///< of the bodies
  std::vector<std::size_t> first_field_;        ///< of each body
  std::vector<std::vector<std::byte>> before_;  ///< of each field
  std::vector<std::string> stages_;             ///< of a table
  std::int64_t step_ = 0;
  int part_ = 0;
  bool in_part_ = false;
  bool with_values_ = false;
  bool closed_ = false;
};

Trace::Trace(const std::filesystem::path& path, const TraceOptions& options)
    : recorder_(std::make_unique<Recorder>(path, options)) {}

Trace::~Trace() {
  try {
    close();
  } catch (const Error&) {  // the run has failed before: what is there of its trace is read all the same
  }
}

void Trace::attach(const Scene& scene, Simulation& simulation) {
  Recorder* const recorder = recorder_.get();
  const auto own = [](auto run) {
    return Stage{.name = "trace", .phase = {}, .run = run, .called_by = "trace"};
  };
  const bool several = simulation.bodies() > 1;
  std::vector<StageName> stages;  // in the order in which they run
  std::vector<Coupling> couplings;
  for (std::size_t phase = 0; phase < static_cast<std::size_t>(Phase::count_); ++phase) {
    for (std::size_t body = 0; body < simulation.bodies(); ++body) {
      std::vector<Stage> traced;
      for (Stage& stage : simulation.plan(body).phases[phase]) {
        stages.push_back({stage.name + (several ? " of body " + std::to_string(body) : ""), stage.called_by});
        traced.push_back(std::move(stage));
        traced.push_back(own([=, number = static_cast<std::uint16_t>(stages.size())](State& state) {
          recorder->record(number, body, state);
        }));
      }
      simulation.plan(body).phases[phase] = std::move(traced);
    }
    for (Coupling& coupling : simulation.couplings()) {
      if (coupling.phase != static_cast<Phase>(phase)) continue;
      const std::size_t left = coupling.left;
      stages.push_back(
          {coupling.name + " of bodies " + std::to_string(left) + " and " + std::to_string(left + 1),
           coupling.called_by});
      couplings.push_back(std::move(coupling));
      couplings.push_back(
          {.name = "trace",
           .phase = static_cast<Phase>(phase),
           .left = left,
           .run = [=, number = static_cast<std::uint16_t>(stages.size())](State& a, State& b) {
             recorder->record(number, left, a);
             recorder->record(number, left + 1, b);
           }});
    }
  }
  simulation.couplings() = std::move(couplings);
  for (std::size_t body = 0; body < simulation.bodies(); ++body) {
    auto& phases = simulation.plan(body).phases;
    const auto begin = own([=](State& state) { recorder->begin_part(body, state); });
    // Without geometry a step begins with the strain.
    for (const Phase first : {Phase::geometry, Phase::strain}) {
      auto& phase = phases[static_cast<std::size_t>(first)];
      phase.insert(phase.begin(), begin);
    }
    phases.back().push_back(own([=](State& state) { recorder->end_part(body, state); }));
  }
  recorder->begin(scene, simulation, stages);
}

void Trace::close() { recorder_->close(); }

}  // namespace hompm
