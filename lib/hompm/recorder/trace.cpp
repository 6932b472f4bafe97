#include <cstring>
#include <string>
#include <utility>
#include <vector>

#include <hompm/build_info.hpp>
#include <hompm/output/text_file.hpp>
#include <hompm/plan/state_fields.hpp>
#include <hompm/recorder/bytes.hpp>
#include <hompm/recorder/trace.hpp>
#include <hompm/recorder/trace_format.hpp>
#include <hompm/scene_file/reader.hpp>

namespace hompm {
namespace {

constexpr std::size_t chunk = 1 << 16;  // bytes per write; whole words for the hash of the file
constexpr const char* beginning = "beginning of the step, or of a part of it";

template <class Values>
std::uint64_t hash_of(const Values& values) {
  detail::Hash hash;
  for (const auto value : values) hash.add(detail::word_of(value));
  return hash.value();
}

}  // namespace

class Trace::Recorder {
 public:
  Recorder(const std::filesystem::path& path, const TraceOptions& options)
      : file_(path, path), options_(options) {}

  void begin(const Scene& scene, const Simulation& simulation) {
    state_ = &simulation.state();
    step_ = state_->step;
    const BuildInfo& build = build_info();
    out_.bytes = detail::trace_magic;
    out_.word(detail::trace_format);
    out_.text("hompm " + build.version + " (" + build.commit + "), " + build.compiler + ", " +
              build.architecture);
    out_.text(scene_text(scene));
    out_.word(state_->particles.markers);
    out_.word(detail::word_of(step_));
    std::vector<const Stage*> stages;
    for (const auto& phase : simulation.plan().phases)
      for (const Stage& stage : phase) stages.push_back(&stage);
    if (stages.size() + 1 >= detail::first_tag) throw Error("too many stages for a trace");
    out_.word(stages.size() + 1);
    out_.text(beginning);
    out_.text("");
    for (const Stage* stage : stages) {
      out_.text(stage->name);
      out_.text(stage->called_by);
    }
    visit_fields(*state_, [&](std::string_view, Site, auto values) {
      const auto bytes = std::as_bytes(values);
      before_.emplace_back(bytes.begin(), bytes.end());
    });
    out_.word(before_.size());
    visit_fields(*state_, [&](std::string_view name, Site site, auto values) {
      using Value = typename decltype(values)::value_type;
      out_.text(name);
      out_.word(static_cast<std::uint64_t>(site));
      out_.word(std::is_integral_v<Value> ? 1 : 0);
      out_.word(values.size());
      out_.word(hash_of(values));
    });
    choose_values();
  }

  /// A step, or a part of one, begins; called more than once for each.
  void begin_part(const State& state) {
    if (&state != state_) return;  // a copy, on which an output is computed
    if (!in_part_) {
      in_part_ = true;
      if (state.step != step_) {
        step_ = state.step;
        out_.word<2>(detail::next_step);
        choose_values();
      } else {
        out_.word<2>(detail::next_part);
      }
    }
    record(0, state);
  }

  void end_part(const State& state) {
    if (&state == state_) in_part_ = false;
  }

  /// What `stage` changed.
  void record(std::uint16_t stage, const State& state) {
    if (&state != state_) return;
    std::size_t field = 0;
    visit_fields(state, [&](std::string_view, Site, auto values) {
      const auto bytes = std::as_bytes(values);
      auto& before = before_[field];
      if (bytes.size() != before.size() || std::memcmp(bytes.data(), before.data(), bytes.size()) != 0) {
        before.assign(bytes.begin(), bytes.end());
        out_.word<2>(stage);
        out_.word<2>(field);
        out_.word(hash_of(values));
        if (with_values_) {
          out_.word<2>(detail::entry_values);
          write_values(values);
        }
      }
      ++field;
    });
    if (out_.bytes.size() >= chunk) flush(out_.bytes.size() / chunk * chunk);
  }

  void close() {
    if (std::exchange(closed_, true)) return;
    const std::uint64_t size = written_ + out_.bytes.size();
    detail::Hash hash = hash_;
    detail::add_bytes(hash, out_.bytes);
    hash.add(size);
    out_.word<2>(detail::trace_end);
    out_.word(hash.value());
    flush(out_.bytes.size());
    file_.close();
  }

 private:
  /// Of the step that begins.
  void choose_values() {
    const bool before =
        std::exchange(with_values_, step_ >= options_.values_from && values_written_ < options_.values_bytes);
    if (!with_values_ || before) return;
    out_.word<2>(detail::all_values);
    visit_fields(*state_, [&](std::string_view, Site, auto values) { write_values(values); });
  }

  template <class Values>
  void write_values(const Values& values) {
    for (const auto value : values) out_.word(detail::word_of(value));
    values_written_ += 8 * values.size();
  }

  void flush(std::size_t size) {
    const std::string_view part = std::string_view(out_.bytes).substr(0, size);
    detail::add_bytes(hash_, part);
    file_ << part;
    written_ += size;
    out_.bytes.erase(0, size);
  }

  detail::TextFile file_;
  TraceOptions options_;
  detail::ByteWriter out_;
  detail::Hash hash_;
  std::uint64_t written_ = 0;
  std::size_t values_written_ = 0;
  const State* state_ = nullptr;
  std::vector<std::vector<std::byte>> before_;  ///< of each field
  std::int64_t step_ = 0;
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
  recorder->begin(scene, simulation);
  const auto own = [](auto run) { return Stage{"trace", "", "trace", run}; };
  const auto begin = own([recorder](State& state) { recorder->begin_part(state); });
  auto& phases = simulation.plan().phases;
  std::uint16_t number = 0;
  for (auto& phase : phases) {
    std::vector<Stage> traced;
    for (Stage& stage : phase) {
      traced.push_back(std::move(stage));
      traced.push_back(own([recorder, index = ++number](State& state) { recorder->record(index, state); }));
    }
    phase = std::move(traced);
  }
  // A step without geometry begins with the stresses at the ends.
  for (const Phase first : {Phase::geometry, Phase::end_stress}) {
    auto& phase = phases[static_cast<std::size_t>(first)];
    phase.insert(phase.begin(), begin);
  }
  phases.back().push_back(own([recorder](State& state) { recorder->end_part(state); }));
}

void Trace::close() { recorder_->close(); }

}  // namespace hompm
