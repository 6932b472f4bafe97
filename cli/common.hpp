// What the command-line tools share: exit codes, options, numbers, columns of text, the frame around main.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <initializer_list>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include <boost/program_options.hpp>

namespace hompm::cli {

/// One line per row, the columns two blanks apart; the first `names` columns are flush left, the others flush
/// right. All rows must be as long as the first.
std::string text_table(const std::vector<std::vector<std::string>>& rows, std::size_t names);

/// `text`, filled up with blanks to `width` columns; at least one, unless it is empty and `width` is 0.
std::string padded(std::string text, std::size_t width);

/// The words of `text` in lines of at most 80 columns: `head` before those of the first line, all words from
/// the column `indent` on, or behind a longer head.
std::string wrapped(const std::string& head, std::size_t indent, const std::string& text);

/// Three digits, in every locale; "-" for what is not finite.
std::string rounded(double value);

/// Sixteen digits.
std::string hex(std::uint64_t word);

/// What a tool hands back to the shell.
enum ExitCode {
  success = 0,      ///< done; for a comparison: identical or equivalent
  internal = 1,     ///< a fault of ours
  usage = 2,        ///< a bad command line or scene: nothing was computed or written
  different = 3,    ///< a comparison found a difference
  invalid_run = 4,  ///< the run stopped being valid
  bad_file = 5,     ///< something could not be read or written, or memory not be had
  arithmetic = 6,   ///< this build or process does not compute as IEEE 754 says; 128 + n: stopped by signal n
};

/// A command line that makes no sense; `what()` says why in one line.
class UsageError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// A command line, read.
struct CommandLine {
  boost::program_options::variables_map options;
  std::vector<std::string> arguments;  ///< what is not an option, in order

  [[nodiscard]] bool has(const std::string& option) const { return options.count(option) > 0; }
  /// The value of an option; "" where it was not given.
  [[nodiscard]] std::string text(const std::string& option) const {
    return has(option) ? options[option].as<std::string>() : "";
  }
  /// The values of one that may be given more than once.
  [[nodiscard]] std::vector<std::string> texts(const std::string& option) const {
    return has(option) ? options[option].as<std::vector<std::string>>() : std::vector<std::string>();
  }
  /// Throws `UsageError`, "<reason> --<option>", where one of the options was given.
  void refuse(std::initializer_list<const char*> others, const std::string& reason) const {
    for (const char* const other : others)
      if (has(other)) throw UsageError(reason + " --" + other);
  }
};

/// The whole of `text` as a finite number. Throws `UsageError`, which begins with `where`, for anything else,
/// "nan" and trailing characters included.
double parse_number(const std::string& text, const std::string& where);
/// The whole of `text` as a number of at least 0, without a sign. Throws `UsageError` as above.
std::uint64_t parse_count(const std::string& text, const std::string& where);

/// The whole of `text` as a number of steps of at least `least`. Throws `UsageError`, which begins with
/// `option` and `text`.
std::int64_t parse_steps(const std::string& text, const std::string& option, std::int64_t least);

/// KEY=VALUE of --set, or what another option calls it, taken apart. Throws `UsageError`.
std::pair<std::string, std::string> key_and_value(const std::string& text,
                                                  const std::string& option = "--set",
                                                  const std::string& form = "KEY=VALUE",
                                                  const std::string& sample = "scheme.cells=32");

/// One line on standard error that is not the end: "hompm-run: warning: <message>".
void warn(const std::string& message);

/// "; did you mean <nearest>?", or nothing when no candidate is near.
std::string suggestion(const std::string& word, const std::vector<std::string>& candidates);

/// An option of a command line.
struct Option {
  std::string name;   ///< without dashes; "help,h" has a letter, too
  std::string value;  ///< what stands behind it; "" for a switch; with "..." it may be given more than once
  std::string meaning;
};

/// Options about one thing.
struct Topic {
  std::string name;   ///< as in `--help accuracy`
  std::string about;  ///< one line
  std::vector<std::string> examples;
  std::vector<Option> options;
};

/// A tool as its --help tells it; the topic "general" (--help, --version, --json) comes with every one.
struct Tool {
  std::string name;
  std::string usage;  ///< behind the name; with what follows no more than 12 lines without arguments
  std::string about;
  std::vector<std::string> examples;
  std::vector<Topic> topics;
  std::string remarks;           ///< behind all options: exit codes
  bool takes_arguments = false;  ///< beside options
};

/// What a main does: reads the command line, answers --help, --version and an empty one, and calls `body` for
/// the rest. Options must be written out: an abbreviation is an error like any unknown name, and the nearest
/// known one is suggested. Turns what is thrown into "<tool>: <message>" on standard error and an exit code,
/// and makes sure that all of standard output was written. A file size limit is an error to report, not a
/// signal, and no file that is opened later gets the place of a standard stream that is closed.
int run_tool(Tool tool, int argc, const char* const* argv,
             const std::function<int(const CommandLine&)>& body);

}  // namespace hompm::cli
