#include "common.hpp"

#include <cerrno>
#include <charconv>
#include <cmath>
#include <csignal>
#include <iostream>
#include <system_error>

#include <hompm/build_info.hpp>
#include <hompm/error.hpp>
#include <hompm/scene_file/reader.hpp>

namespace hompm::cli {
namespace {

namespace po = boost::program_options;

/// Reads all of `text`; false when that is not possible.
template <class Number>
bool read_whole(const std::string& text, Number& number) {
  const char* const end = text.data() + text.size();
  const auto [stop, error] = std::from_chars(text.data(), end, number);
  return error == std::errc{} && stop == end;
}

CommandLine read_command_line(int argc, const char* const* argv, const po::options_description& options) {
  // The name of the option behind the arguments holds a blank, so that nobody can type it by accident.
  const char* const arguments = "other arguments";
  po::options_description all;
  all.add(options).add_options()(arguments, po::value<std::vector<std::string>>());
  po::positional_options_description positional;
  positional.add(arguments, -1);
  try {
    CommandLine line;
    const int style = po::command_line_style::unix_style & ~po::command_line_style::allow_guessing;
    const auto parsed =
        po::command_line_parser(argc, argv).options(all).positional(positional).style(style).run();
    for (const auto& option : parsed.options) {
      const auto& tokens = option.original_tokens;
      // The parser would take the next option for the missing value of this one.
      if (tokens.size() == 2 && option.position_key < 0 && tokens[1].starts_with("--")) {
        throw UsageError("the value of " + tokens[0] + " is missing: " + tokens[1] + " is an option");
      }
    }
    po::store(parsed, line.options);
    po::notify(line.options);
    if (line.options.count(arguments) > 0)
      line.arguments = line.options[arguments].as<std::vector<std::string>>();
    return line;
  } catch (const po::unknown_option& error) {
    std::vector<std::string> known;
    for (const auto& option : options.options()) known.push_back("--" + option->long_name());
    throw UsageError("unknown option " + error.get_option_name() +
                     suggestion(error.get_option_name(), known));
  } catch (const po::error& error) {
    throw UsageError(error.what());
  }
}

/// What --help prints.
std::ostream& operator<<(std::ostream& out, const Tool& tool) {
  return out << tool.synopsis << '\n' << tool.options << '\n' << tool.remarks;
}

int answer(Tool& tool, int argc, const char* const* argv,
           const std::function<int(const CommandLine&)>& body) {
  tool.options.add_options()("version", "print the version")("help", "print this");
  if (argc < 2) {
    std::cerr << tool;
    return usage;
  }
  const CommandLine line = read_command_line(argc, argv, tool.options);
  if (!tool.takes_arguments && !line.arguments.empty())
    throw UsageError("`" + line.arguments.front() + "` is not an option");
  if (line.options.count("help") > 0) {
    std::cout << tool;
    return success;
  }
  if (line.options.count("version") > 0) {
    std::cout << tool.name << ' ' << build_info().version << '\n';
    return success;
  }
  return body(line);
}

}  // namespace

double parse_number(const std::string& text, const std::string& where) {
  double number = 0.0;
  if (read_whole(text, number) && std::isfinite(number)) return number;
  throw UsageError(where + ": `" + text + "` is not a finite number");
}

std::uint64_t parse_count(const std::string& text, const std::string& where) {
  std::uint64_t number = 0;
  if (read_whole(text, number)) return number;
  throw UsageError(where + ": `" + text + "` is not a whole number of at least 0");
}

std::int64_t parse_steps(const std::string& text, const std::string& option, std::int64_t least) {
  std::int64_t number = 0;
  if (read_whole(text, number) && number >= least) return number;
  throw UsageError(option + " " + text + ": expected a number of steps, a whole number of at least " +
                   std::to_string(least));
}

void warn(const std::string& message) { std::cerr << "hompm-run: warning: " << message << std::endl; }

std::string suggestion(const std::string& word, const std::vector<std::string>& candidates) {
  const std::string near = nearest(word, candidates);
  return near.empty() ? "" : "; did you mean " + near + "?";
}

int run_tool(Tool tool, int argc, const char* const* argv,
             const std::function<int(const CommandLine&)>& body) {
  std::signal(SIGXFSZ, SIG_IGN);
  const auto fail = [&](const std::string& message, int code) {
    std::cerr << tool.name << ": " << message << '\n';
    return code;
  };
  try {
    const int code = answer(tool, argc, argv, body);
    errno = 0;
    if (!std::cout.flush()) {
      const int reason = errno != 0 ? errno : EIO;  // an earlier write may have failed, its reason forgotten
      return fail("cannot write standard output: " + std::generic_category().message(reason), bad_file);
    }
    return code;
  } catch (const UsageError& error) {
    return fail(std::string(error.what()) + " (see " + tool.name + " --help)", usage);
  } catch (const SceneError& error) {
    return fail(error.what(), usage);
  } catch (const InvalidRun& error) {
    return fail(error.what(), invalid_run);
  } catch (const FileError& error) {
    return fail(error.what(), bad_file);
  } catch (const ArithmeticError& error) {
    return fail(error.what(), arithmetic);
  } catch (const std::exception& error) {
    return fail(std::string("internal error: ") + error.what(), internal);
  }
}

}  // namespace hompm::cli
