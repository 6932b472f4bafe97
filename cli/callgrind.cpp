#include "callgrind.hpp"

#include <algorithm>
#include <array>
#include <cstdio>
#include <cstdlib>
#include <filesystem>

#include <hompm/error.hpp>

#include "child.hpp"

namespace hompm::cli {
namespace {

namespace fs = std::filesystem;

std::uint64_t number_after(const std::string& text, const std::string& label) {
  const auto found = text.find(label);
  return found == std::string::npos ? 0 : std::strtoull(text.c_str() + found + label.size(), nullptr, 10);
}

}  // namespace

bool has_callgrind() {
#ifdef __SANITIZE_ADDRESS__
  return false;  // the two cannot run together
#else
  static const bool found = [] {
    const Scratch scratch;
    return run_child({"valgrind", "--version"}, scratch.path() + "/out", scratch.path() + "/log", [] {}) == 0;
  }();
  return found;
#endif
}

std::string program_path() { return fs::read_symlink("/proc/self/exe").string(); }

std::string program_id() {
  static const std::string id = [] {
    const auto text = study::text_of(program_path());
    if (!text) throw FileError("cannot read " + program_path());
    std::uint64_t hash = 14695981039346656037U;
    for (const char c : *text) hash = (hash ^ static_cast<unsigned char>(c)) * 1099511628211U;
    std::array<char, 17> hex{};
    std::snprintf(hex.data(), hex.size(), "%016llx", static_cast<unsigned long long>(hash));
    return std::string(hex.data());
  }();
  return id;
}

/// Above 2 KB glibc copies and clears arrays by one repeated instruction, of which callgrind counts every
/// turn.
constexpr const char* vectors_at_any_size =
    "GLIBC_TUNABLES=glibc.cpu.x86_rep_movsb_threshold=0x40000000:glibc.cpu.x86_rep_stosb_threshold="
    "0x40000000";

study::Instructions count_instructions(const study::Measured& measured, const study::Check& check) {
  const Scratch scratch;
  study::write_moments(scratch.path(), measured);
  const std::string log = scratch.path() + "/log";
  const int code = run_child(
      {"env", vectors_at_any_size, "valgrind", "--tool=callgrind",
       "--callgrind-out-file=" + scratch.path() + "/out", "--collect-atstart=no",
       "--toggle-collect=hompm::Simulation::step(double)", program_path(), "--count", scratch.path()},
      log, log, check);
  const std::string said = study::text_of(log).value_or("");
  const auto counted = number_after(said, "Collected : ");
  const auto steps = number_after(said, "counted steps: ");
  if (code != 0 || counted == 0 || steps == 0)
    throw Error("counting instructions of " + measured.record.name + " failed (exit code " +
                std::to_string(code) +
                "): " + said.substr(said.size() - std::min<std::size_t>(said.size(), 300)));
  return study::extrapolated(counted, static_cast<std::int64_t>(steps), measured.record.work);
}

}  // namespace hompm::cli
