#include "gnuplot.hpp"

#include <algorithm>

#include <hompm/error.hpp>
#include <hompm/study/record.hpp>

#include "child.hpp"

namespace hompm::cli {

std::optional<std::string> run_gnuplot(const std::string& script) {
  const Scratch scratch;
  const auto file = [&](const char* name) { return scratch.path() + "/" + name; };
  study::write_whole(file("script"), script);
  // -d: none of the user's settings, the same picture for everybody.
  const int code = run_child({"gnuplot", "-d", file("script")}, file("out"), file("log"), [] {});
  if (code == no_such_program) return std::nullopt;
  if (code == 0) return study::text_of(file("out")).value_or("");
  std::string said = study::text_of(file("log")).value_or("").substr(0, 300);
  std::ranges::replace(said, '\n', ' ');
  throw FileError("gnuplot failed: " + said);
}

}  // namespace hompm::cli
