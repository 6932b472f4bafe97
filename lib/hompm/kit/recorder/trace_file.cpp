#include <algorithm>
#include <utility>

#include <hompm/kit/recorder/trace_file.hpp>

namespace hompm::detail {
namespace {

constexpr std::size_t end_size = 2 + 8;  // tag and hash
constexpr std::size_t most = std::size_t{1}
                             << 48U;  // numbers above this are damage, and do not overflow below

}  // namespace

TraceFile::TraceFile(const std::filesystem::path& path, std::string shown)
    : name(std::move(shown)), bytes_(read_file(path)) {
  std::string_view all = bytes_;
  if (!all.starts_with(trace_magic))
    throw FileError("cannot read " + name + ": it is not a trace of hompm-run --trace");
  if (all.size() >= end_size) {
    ByteReader end(all.substr(all.size() - end_size));
    if (end.word<2>() == trace_end) {
      all.remove_suffix(end_size);
      if (end.word() != hash_of_bytes(all)) damaged();
      complete_ = true;
    }
  }
  in_ = ByteReader(all.substr(trace_magic.size()));
  try {
    read_header();
  } catch (const BytesEnd&) {
    throw FileError("cannot read " + name + ": the trace is cut short before the first step");
  }
  read_next();
}

void TraceFile::damaged() const { throw FileError("cannot read " + name + ": the trace is damaged"); }

/// A text that is shown: without control characters.
std::string TraceFile::word() {
  std::string text = in_.text();
  if (std::any_of(text.begin(), text.end(), [](unsigned char c) { return c < 0x20 || c == 0x7f; })) damaged();
  return text;
}

/// What places and particles are named by fits together.
void TraceFile::check_fields() const {
  if (fields.empty() || markers > most || first_step < 0 || first_step > static_cast<std::int64_t>(most))
    damaged();
  std::size_t sites = 0;  // particles and markers of the body
  for (std::size_t i = 0; i < fields.size(); ++i) {
    const auto [site, size] = std::pair(fields[i].site, fields[i].size);
    if (size > most || site > Site::function) damaged();
    if (i > 0 && fields[i].body != fields[i - 1].body) sites = 0;
    if (site == Site::particle && sites == 0) sites = size;
    if (site == Site::particle && (size != sites || size <= 2 * markers)) damaged();
    if (site == Site::particle_function && (sites == 0 || size == 0 || size % sites != 0)) damaged();
  }
}

void TraceFile::read_header() {
  if (const auto format = in_.word(); format != trace_format)
    throw FileError("cannot read " + name + ": the trace has the format " + std::to_string(format) +
                    ", and this hompm reads " + std::to_string(trace_format));
  build = word();
  scene = in_.text();
  markers = static_cast<std::size_t>(in_.word());
  first_step = step_ = static_cast<std::int64_t>(in_.word());
  stages.resize(in_.count(16));
  for (TraceStage& stage : stages) stage = {word(), word()};
  fields.resize(in_.count(48));
  std::size_t next_body = 0;
  for (TraceField& field : fields) {
    field.name = word();
    field.body = static_cast<std::size_t>(in_.word());
    if (field.body > next_body) damaged();
    next_body = field.body + 1;
    field.site = static_cast<Site>(in_.word());
    field.is_integer = in_.word() != 0;
    field.size = static_cast<std::size_t>(in_.word());
    field.hash = in_.word();
  }
  check_fields();
}

void TraceFile::take() {
  TraceField& field = fields[next_->field];
  field.hash = next_hash_;
  field.values = next_values_;
  read_next();
}

void TraceFile::read_next() {
  next_.reset();
  try {
    while (in_.left() > 0) {
      const auto tag = in_.word<2>();
      if (tag == next_step) {
        ++step_;
        part_ = 1;
      } else if (tag == next_part) {
        ++part_;
      } else if (tag == all_values) {
        for (TraceField& field : fields) field.values = in_.raw(8 * field.size);
      } else if (tag == trace_end && in_.left() < 8) {
        in_ = ByteReader("");  // cut off in its last bytes
      } else {
        return read_entry(tag);
      }
    }
  } catch (const BytesEnd&) {
    if (complete_) damaged();
    in_ = ByteReader("");  // the run was cut off while it wrote
  }
}

void TraceFile::read_entry(std::uint64_t stage) {
  const auto field = in_.word<2>();
  if (stage >= stages.size() || field >= fields.size()) damaged();
  const auto hash = in_.word();
  ByteReader peek = in_;
  next_values_ = {};
  if (in_.left() >= 2 && peek.word<2>() == entry_values) {
    next_values_ = peek.raw(8 * fields[field].size);
    in_ = peek;
  }
  next_hash_ = hash;
  next_ = TraceEntry{step_, part_, static_cast<std::size_t>(stage), static_cast<std::size_t>(field)};
}

}  // namespace hompm::detail
