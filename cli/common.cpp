#include "common.hpp"

#include <algorithm>
#include <array>
#include <cerrno>
#include <charconv>
#include <cmath>
#include <csignal>
#include <fcntl.h>
#include <iostream>
#include <new>
#include <sstream>
#include <system_error>
#include <unistd.h>

#include <nlohmann/json.hpp>

#include <hompm/build_info.hpp>
#include <hompm/kit/scene_file/reader.hpp>
#include <hompm/kit/scene_file/value_rule.hpp>

namespace hompm::cli {

std::string text_table(const std::vector<std::vector<std::string>>& rows, std::size_t names) {
  std::vector<std::size_t> width(rows.empty() ? 0 : rows.front().size());
  for (const auto& row : rows)
    for (std::size_t i = 0; i < row.size(); ++i) width[i] = std::max(width[i], row[i].size());
  std::string text;
  for (const auto& row : rows) {
    std::string line;
    for (std::size_t i = 0; i < row.size(); ++i) {
      const std::string padding(width[i] - row[i].size(), ' ');
      line += (i == 0 ? "" : "  ") + (i < names ? row[i] + padding : padding + row[i]);
    }
    text += line.substr(0, line.find_last_not_of(' ') + 1) + "\n";
  }
  return text;
}

namespace {

/// Columns that UTF-8 takes on a terminal: its bytes that continue no character.
std::size_t columns(const std::string& text) {
  return static_cast<std::size_t>(std::ranges::count_if(text, [](char c) { return (c & 0xC0) != 0x80; }));
}

}  // namespace

std::string padded(std::string text, std::size_t width) {
  const std::size_t now = columns(text);
  if (now >= width) return text + (text.empty() ? "" : " ");
  return text.append(width - now, ' ');
}

std::string wrapped(const std::string& head, std::size_t indent, const std::string& text) {
  std::string all;
  std::string line = padded(head, indent);
  std::istringstream words(text);
  const char* blank = "";
  for (std::string word; words >> word; blank = " ") {
    if (*blank != '\0' && columns(line) + 1 + columns(word) > 80) {
      all += line + "\n";
      line.assign(indent, ' ');
      blank = "";
    }
    line += blank + word;
  }
  return all + line + "\n";
}

std::string hex(std::uint64_t word) {
  std::array<char, 17> digits{};
  std::snprintf(digits.data(), digits.size(), "%016llx", static_cast<unsigned long long>(word));
  return digits.data();
}

std::string rounded(double value) {
  if (!std::isfinite(value)) return "-";
  std::array<char, 32> buffer{};
  char* const begin = buffer.data();
  const auto end = std::to_chars(begin, begin + buffer.size(), value, std::chars_format::general, 3).ptr;
  return {begin, end};
}

}  // namespace hompm::cli

namespace hompm {

NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(BuildInfo, version, commit, compiler, flags, build_type, architecture,
                                   boost)

namespace cli {

NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(Option, name, value, meaning)
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(Topic, name, about, examples, options)
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(Tool, name, usage, about, examples, topics, remarks)

namespace {

namespace po = boost::program_options;

/// Reads all of `text`; false when that is not possible.
template <class Number>
bool read_whole(const std::string& text, Number& number) {
  const char* const end = text.data() + text.size();
  const auto [stop, error] = std::from_chars(text.data(), end, number);
  return error == std::errc{} && stop == end;
}

CommandLine read_command_line(int argc, const char* const* argv, const Tool& tool) {
  // The name of the option behind the arguments holds a blank, so that nobody can type it by accident.
  const char* const arguments = "other arguments";
  po::options_description all;
  std::vector<std::string> known;
  for (const Topic& topic : tool.topics)
    for (const Option& option : topic.options) {
      known.push_back("--" + option.name.substr(0, option.name.find(',')));
      if (option.value.empty())
        all.add_options()(option.name.c_str(), "");
      else if (option.value.ends_with("..."))
        all.add_options()(option.name.c_str(), po::value<std::vector<std::string>>()->composing());
      else
        all.add_options()(option.name.c_str(), po::value<std::string>());
    }
  all.add_options()(arguments, po::value<std::vector<std::string>>());
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
    throw UsageError("unknown option " + error.get_option_name() +
                     suggestion(error.get_option_name(), known));
  } catch (const po::error& error) {
    throw UsageError(error.what());
  }
}

/// What a command line without arguments prints.
std::string short_help(const Tool& tool) {
  std::string text = "usage: " + tool.name + " " + tool.usage + "\n" + wrapped("", 0, tool.about) + "\n";
  for (const auto& example : tool.examples) text += "  " + example + "\n";
  std::string names;
  for (const Topic& topic : tool.topics) names += " " + topic.name;
  return text + "\n" + wrapped(tool.name + " --help TOPIC:", 2, names) + tool.name + " --help: all options\n";
}

std::string topic_text(const Topic& topic) {
  std::string text = "\n" + wrapped(topic.name + ":", 2, topic.about);
  for (const auto& example : topic.examples) text += "  " + example + "\n";
  for (const Option& option : topic.options) {
    const auto comma = option.name.find(',');
    const std::string letter = comma == std::string::npos ? "" : "-" + option.name.substr(comma + 1) + ", ";
    text +=
        wrapped("  " + letter + "--" + option.name.substr(0, comma) + " " + option.value, 27, option.meaning);
  }
  return text;
}

void print_help(const Tool& tool, const CommandLine& line) {
  const auto& words = line.arguments;
  if (words.size() > 1) throw UsageError("--help takes one topic, not also `" + words[1] + "`");
  std::vector<std::string> names;
  for (const Topic& topic : tool.topics) {
    names.push_back(topic.name);
    if (!words.empty() && words[0] == topic.name) {
      std::cout << topic_text(topic).substr(1);
      return;
    }
  }
  if (!words.empty())
    throw UsageError("--help has no topic `" + words[0] + "`" + suggestion(words[0], names));
  if (line.options.count("json") > 0) {
    std::cout << nlohmann::json(tool).dump(2) << '\n';
    return;
  }
  std::cout << short_help(tool);
  for (const Topic& topic : tool.topics) std::cout << topic_text(topic);
  std::cout << '\n' << tool.remarks;
}

int answer(Tool& tool, int argc, const char* const* argv,
           const std::function<int(const CommandLine&)>& body) {
  tool.topics.push_back({"general",
                         "what every tool knows",
                         {},
                         {{"help,h", "", "print all options; behind it a topic; with --json for programs"},
                          {"version,V", "", "print version and commit; with --json all of the build"},
                          {"json", "", "print one JSON object in the place of text"}}});
  if (argc < 2) {
    std::cerr << short_help(tool);
    return usage;
  }
  const CommandLine line = read_command_line(argc, argv, tool);
  if (line.options.count("help") > 0) {
    print_help(tool, line);
    return success;
  }
  if (!tool.takes_arguments && !line.arguments.empty())
    throw UsageError("`" + line.arguments.front() + "` is not an option");
  if (line.options.count("version") > 0) {
    if (line.options.count("json") > 0)
      std::cout << nlohmann::json(build_info()).dump(2) << '\n';
    else
      std::cout << tool.name << ' ' << build_info().version << " (" << build_info().commit << ")\n";
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

std::pair<std::string, std::string> key_and_value(const std::string& text, const std::string& option,
                                                  const std::string& form, const std::string& sample) {
  const auto equals = text.find('=');
  if (equals != std::string::npos && equals > 0) return {text.substr(0, equals), text.substr(equals + 1)};
  throw UsageError(option + " " + text + ": expected " + form + ", as in " + option + " " + sample);
}

void warn(const std::string& message) { std::cerr << "hompm-run: warning: " << message << std::endl; }

std::string suggestion(const std::string& word, const std::vector<std::string>& candidates) {
  const std::string near = nearest(word, candidates);
  return near.empty() ? "" : "; did you mean " + near + "?";
}

namespace {

/// A standard stream that is closed is opened, such that reading or writing it fails as before.
void open_standard_streams() {
  for (const int stream : {STDIN_FILENO, STDOUT_FILENO, STDERR_FILENO})
    if (::fcntl(stream, F_GETFD) < 0) {
      const int flags = stream == STDIN_FILENO ? O_WRONLY : O_RDONLY;
      if (::open("/dev/null", flags) < 0) ::_exit(bad_file);  // it takes the lowest place that is free: this
    }
}

}  // namespace

int run_tool(Tool tool, int argc, const char* const* argv,
             const std::function<int(const CommandLine&)>& body) {
  open_standard_streams();
  std::signal(SIGXFSZ, SIG_IGN);
  const auto fail = [&](const std::string& message, int code) {
    std::cerr << tool.name << ": " << message << '\n';
    return code;
  };
  // Words of the command line and names of files may hold anything.
  const auto fail_on_one_line = [&](const std::exception& error, const std::string& hint, int code) {
    const std::string message = error.what();
    return fail(detail::printable(message, message.size()) + hint, code);
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
    return fail_on_one_line(error, " (see " + tool.name + " --help)", usage);
  } catch (const SceneError& error) {
    return fail(error.what(), usage);
  } catch (const InvalidRun& error) {
    return fail(error.what(), invalid_run);
  } catch (const FileError& error) {
    return fail_on_one_line(error, "", bad_file);
  } catch (const ArithmeticError& error) {
    return fail(error.what(), arithmetic);
  } catch (const std::bad_alloc&) {
    return fail("there is not enough memory", bad_file);
  } catch (const std::length_error&) {
    return fail("there is not enough memory: more than any machine has was asked for", bad_file);
  } catch (const std::exception& error) {
    return fail(std::string("internal error: ") + error.what(), internal);
  }
}

}  // namespace cli
}  // namespace hompm
