#include <algorithm>
#include <array>
#include <cerrno>
#include <cmath>
#include <fstream>
#include <system_error>
#include <utility>

#include <hompm/error.hpp>
#include <hompm/number.hpp>

namespace hompm {
namespace {

std::string join(const std::vector<Problem>& problems) {
  constexpr std::size_t most = 100;
  std::string text;
  for (std::size_t i = 0; i < std::min(problems.size(), most); ++i) {
    if (!text.empty()) text += '\n';
    text += problems[i].origin.text() + ": " + problems[i].message;
  }
  if (problems.size() > most) text += "\nand " + std::to_string(problems.size() - most) + " more problems";
  return text;
}

std::string invalid_text(std::int64_t step, double time, std::int64_t particle, const std::string& reason) {
  std::string text = "invalid at step " + std::to_string(step) +
                     ", t = " + (std::isfinite(time) ? to_text(time) + " s" : std::string("not finite"));
  if (particle >= 0) text += ", particle " + std::to_string(particle);
  return text + ": " + reason;
}

}  // namespace

std::string Origin::text() const {
  if (line <= 0) return source;
  return source + ':' + std::to_string(line) + ':' + std::to_string(column);
}

SceneError::SceneError(std::vector<Problem> problems)
    : Error(join(problems)), problems_(std::move(problems)) {}

SceneError::SceneError(const Origin& origin, const std::string& message)
    : SceneError(std::vector<Problem>{{origin, message}}) {}

InvalidRun::InvalidRun(std::int64_t step_, double time_, std::int64_t particle_, const std::string& reason_)
    : Error(invalid_text(step_, time_, particle_, reason_)),
      step(step_),
      time(time_),
      particle(particle_),
      reason(reason_) {}

FileError::FileError(std::string_view action, const std::filesystem::path& path, int error_number)
    : Error("cannot " + std::string(action) + " " + path.string() + ": " +
            std::generic_category().message(error_number)) {}

std::string read_file(const std::filesystem::path& path, std::size_t most) {
  std::error_code ignored;
  if (std::filesystem::is_directory(path, ignored))
    throw FileError("cannot read " + path.string() + ": it is a folder");
  errno = 0;
  std::ifstream file(path, std::ios::binary);
  std::string text;
  std::array<char, 1 << 16> chunk{};
  while (file.read(chunk.data(), chunk.size()), file.gcount() > 0) {
    text.append(chunk.data(), static_cast<std::size_t>(file.gcount()));
    if (text.size() > most)
      throw FileError("cannot read " + path.string() + ": it has more than " + std::to_string(most >> 20U) +
                      " MiB");
  }
  if (!file.is_open() || file.bad()) throw FileError("read", path, errno);
  return text;
}

}  // namespace hompm
