#include "foreign_formats.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cctype>
#include <cerrno>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <fstream>
#include <map>
#include <sstream>
#include <string_view>
#include <unistd.h>
#include <utility>
#include <vector>
#include <zlib.h>

#include <boost/property_tree/ptree.hpp>
#include <boost/property_tree/xml_parser.hpp>

#include <hompm/error.hpp>

namespace hompm::cli {
namespace {

namespace fs = std::filesystem;
using Tree = boost::property_tree::ptree;

[[noreturn]] void refuse(const std::string& name, const std::string& reason) {
  throw FileError("cannot read " + name + ": " + reason);
}

/// All that is in a file or pipe, uncompressed. A table without compression may be larger than memory: of a
/// regular file only `most` bytes are read.
std::string contents(const std::string& name, std::size_t most) {
  const gzFile file = name == "-" ? gzdopen(::dup(0), "rb") : gzopen(name.c_str(), "rb");
  if (file == nullptr) throw FileError("read", name, errno != 0 ? errno : ENOMEM);
  std::string text;
  std::vector<char> buffer(1 << 18);
  int count = 0;
  while (text.size() < most &&
         (count = gzread(file, buffer.data(), static_cast<unsigned>(buffer.size()))) > 0)
    text.append(buffer.data(), static_cast<std::size_t>(count));
  int error = Z_OK;
  const std::string reason = gzerror(file, &error);
  gzclose(file);
  if (error == Z_ERRNO) throw FileError("read", name, errno);
  if (error != Z_OK && error != Z_STREAM_END)
    refuse(name, "the compressed file is cut or damaged: " + reason);
  return text;
}

/// Formats that are not read here, by their first bytes, and what converts them.
void refuse_others(const std::string& name, std::string_view text) {
  using namespace std::string_view_literals;
  struct Other {
    std::string_view magic;
    const char* format;
    const char* cure;
  };
  constexpr const char* meshio = "`meshio convert FILE mine.vtu` may convert it";
  constexpr const char* python = "write it as a table with numpy.savetxt";
  static const std::array<Other, 15> others{
      {{"\x89HDF"sv, "an HDF5 file",
        "read it with h5py (or meshio, if it is XDMF) and write a table with numpy.savetxt"},
       {"MATLAB 5.0"sv, "a MATLAB file",
        "in Octave: load it and save -ascii, or scipy.io.loadmat and numpy.savetxt"},
       {"# vtk DataFile"sv, "a legacy VTK file", meshio},
       {"\x93NUMPY"sv, "a numpy array", python},
       {"PK\x03\x04"sv, "a ZIP archive (.npz, .xlsx, …)",
        "numpy.load and numpy.savetxt, or save the sheet as CSV"},
       {"CDF"sv, "a NetCDF file (Exodus?)", meshio},
       {"*HEADING"sv, "an ABAQUS input file", meshio},
       {"*Heading"sv, "an ABAQUS input file", meshio},
       {"$MeshFormat"sv, "a Gmsh file", meshio},
       {"PAR1"sv, "a Parquet file", "pandas.read_parquet and to_csv"},
       {"\x28\xb5\x2f\xfd"sv, "compressed by zstd", "unzstd FILE"},
       {"BZh"sv, "compressed by bzip2", "bunzip2 FILE"},
       {"\xfd\x37zXZ"sv, "compressed by xz", "unxz FILE"},
       {"\xff\xfe"sv, "text in UTF-16", "iconv -f UTF-16 -t UTF-8 FILE"},
       {"{"sv, "JSON", "write a table with one row for each time and particle"}}};
  for (const auto& other : others)
    if (text.starts_with(other.magic))
      refuse(name, std::string("this is ") + other.format + ": " + other.cure);
  if (text.substr(0, 512).find('\0') != text.npos)
    refuse(name, "this is not text, and no format that is known here; " + std::string(meshio));
}

std::string number(double value) {
  std::array<char, 32> text{};
  return {text.begin(), std::to_chars(text.begin(), text.end(), value).ptr};
}

// --- VTK XML
// -----------------------------------------------------------------------------------------------------

std::string from_base64(std::string_view text) {
  static const std::string_view letters = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string bytes;
  std::uint32_t group = 0;
  int bits = 0;
  for (const char c : text) {
    const auto value = letters.find(c);
    if (value == letters.npos) {  // blanks; padding ends a group
      if (c == '=') bits = 0;
      continue;
    }
    group = group << 6 | static_cast<std::uint32_t>(value);
    bits += 6;
    if (bits >= 8) {
      bits -= 8;
      bytes += static_cast<char>(group >> bits & 0xff);
    }
  }
  return bytes;
}

template <class T>
T value_at(std::string_view bytes, std::size_t i, bool swapped) {
  std::array<char, sizeof(T)> raw{};
  std::memcpy(raw.data(), bytes.data() + i * sizeof(T), sizeof(T));
  if (swapped) std::ranges::reverse(raw);
  return std::bit_cast<T>(raw);
}

template <class T>
std::vector<double> values_of(std::string_view bytes, bool swapped) {
  std::vector<double> values(bytes.size() / sizeof(T));
  for (std::size_t i = 0; i < values.size(); ++i)
    values[i] = static_cast<double>(value_at<T>(bytes, i, swapped));
  return values;
}

/// One file: points, their data, its time.
class VtkReader {
 public:
  VtkReader(std::string name, std::string text, char direction)
      : name_(std::move(name)), direction_(direction) {
    // Appended data may be raw, which no XML is.
    const auto open = text.find("<AppendedData");
    const auto begin = open == text.npos ? open : text.find('_', open);
    const auto close = text.rfind("</AppendedData>");
    if (begin != text.npos && close != text.npos && begin < close) {
      raw_ = text.substr(open, begin - open).find("raw") != text.npos;
      appended_ = text.substr(begin + 1, close - begin - 1);
      text.erase(begin, close - begin);
    }
    try {
      std::istringstream stream(text);
      boost::property_tree::read_xml(stream, tree_);
    } catch (const boost::property_tree::xml_parser_error& error) {
      refuse(name_, "this is not whole XML: " + error.message() + " in line " + std::to_string(error.line()));
    }
    if (tree_.count("VTKFile") == 0) refuse(name_, "this is XML, but no VTK file");
    file_ = &tree_.get_child("VTKFile");
    const bool little = attribute(*file_, "byte_order", "LittleEndian") == "LittleEndian";
    swapped_ = little != (std::endian::native == std::endian::little);
    long_headers_ = attribute(*file_, "header_type", "UInt32") == "UInt64";
    compressor_ = attribute(*file_, "compressor", "");
    if (!compressor_.empty() && compressor_ != "vtkZLibDataCompressor")
      refuse(name_, "it is compressed by " + compressor_ + "; only zlib is known here");
  }

  [[nodiscard]] bool is_series() const { return file_->count("Collection") > 0; }
  /// Of a series: time and file of each part.
  [[nodiscard]] std::vector<std::pair<std::string, std::string>> parts() const {
    std::vector<std::pair<std::string, std::string>> all;
    for (const auto& [tag, node] : file_->get_child("Collection"))
      if (tag == "DataSet") all.emplace_back(attribute(node, "timestep", "0"), attribute(node, "file", ""));
    return all;
  }

  /// Adds the particles as rows, below a header where there is none yet.
  void add_rows(std::string& table, const std::string& time) const {
    for (const char* kind : {"UnstructuredGrid", "PolyData"}) {
      const auto data = file_->get_child_optional(kind);
      if (!data) continue;
      std::string when = time;
      if (const auto fields = data->get_child_optional("FieldData"); fields && when.empty()) {
        for (const auto& [tag, array] : *fields)
          if (tag == "DataArray" && attribute(array, "Name", "") == "TimeValue")
            when = number(values(array).at(0));
      }
      for (const auto& [tag, piece] : *data)
        if (tag == "Piece") add_piece(table, piece, when);
      return;
    }
    refuse(name_, "only UnstructuredGrid (.vtu), PolyData (.vtp) and Collection (.pvd) are read");
  }

 private:
  static std::string attribute(const Tree& node, const std::string& key, const std::string& standard) {
    return node.get("<xmlattr>." + key, standard);
  }

  void add_piece(std::string& table, const Tree& piece, const std::string& time) const {
    std::vector<std::pair<std::string, std::vector<double>>> columns;
    const auto points = piece.get_child_optional("Points.DataArray");
    if (!points) refuse(name_, "there are no points");
    columns.emplace_back(std::string(1, direction_), component(*points));
    const std::size_t n = columns.front().second.size();
    if (const auto data = piece.get_child_optional("PointData")) {
      for (const auto& [tag, array] : *data) {
        const std::string array_name = attribute(array, "Name", "");
        if (tag != "DataArray" || attribute(array, "type", "") == "String") continue;
        auto column = component(array);
        if (column.size() != n)
          refuse(name_, "the array `" + array_name + "` has not one value for each point");
        columns.emplace_back(array_name, std::move(column));
      }
    }
    std::string header = time.empty() ? "" : "time,";
    for (const auto& [column, values] : columns) header += "\"" + column + "\",";
    header.back() = '\n';
    if (table.empty()) table = header;
    if (!table.starts_with(header)) refuse(name_, "its arrays are not those of the file before");
    for (std::size_t i = 0; i < n; ++i) {
      if (!time.empty()) table += time + ",";
      for (const auto& [column, values] : columns) table += number(values[i]) + ",";
      table.back() = '\n';
    }
  }

  /// The component of vectors and tensors in the direction.
  [[nodiscard]] std::vector<double> component(const Tree& array) const {
    const auto all = values(array);
    const auto count = static_cast<std::size_t>(std::max(1, array.get("<xmlattr>.NumberOfComponents", 1)));
    const auto axis = static_cast<std::size_t>(direction_ - 'x');
    const std::size_t at = count == 9 ? 4 * axis : count == 4 ? 3 * axis : count == 1 ? 0 : axis;
    if (at >= count)
      refuse(name_,
             "an array of " + std::to_string(count) + " components has none in the direction asked for");
    std::vector<double> some;
    for (std::size_t i = at; i < all.size(); i += count) some.push_back(all[i]);
    return some;
  }

  [[nodiscard]] std::vector<double> values(const Tree& array) const {
    const std::string format = attribute(array, "format", "ascii");
    const std::string text = array.get_value<std::string>();
    if (format == "ascii") return ascii(text);
    const std::string type = attribute(array, "type", "Float32");
    const std::string bytes =
        format == "appended"
            ? decoded(std::string_view(appended_).substr(
                          std::min(appended_.size(), array.get<std::size_t>("<xmlattr>.offset", 0))),
                      raw_)
            : decoded(text.substr(std::min(text.size(), text.find_first_not_of(" \t\r\n"))), false);
    static const std::map<std::string, std::vector<double> (*)(std::string_view, bool)> types{
        {"Float64", values_of<double>},     {"Float32", values_of<float>},
        {"Int64", values_of<std::int64_t>}, {"UInt64", values_of<std::uint64_t>},
        {"Int32", values_of<std::int32_t>}, {"UInt32", values_of<std::uint32_t>},
        {"Int16", values_of<std::int16_t>}, {"UInt16", values_of<std::uint16_t>},
        {"Int8", values_of<std::int8_t>},   {"UInt8", values_of<std::uint8_t>}};
    const auto known = types.find(type);
    if (known == types.end()) refuse(name_, "the type of number " + type + " is unknown");
    return known->second(bytes, swapped_);
  }

  [[nodiscard]] std::vector<double> ascii(const std::string& text) const {
    std::vector<double> values;
    for (const char *at = text.data(), *last = at + text.size(); at != last;) {
      if (std::isspace(static_cast<unsigned char>(*at)) != 0) {
        ++at;
        continue;
      }
      double value = 0.0;
      const auto [end, error] = std::from_chars(at, last, value);
      if (error == std::errc::invalid_argument)
        refuse(name_, "`" + std::string(at, std::min<std::size_t>(20, static_cast<std::size_t>(last - at))) +
                          "` is not a number");
      values.push_back(error == std::errc{} ? value : std::nan(""));
      at = end;
    }
    return values;
  }

  /// The bytes of an array behind the header that says how many they are.
  [[nodiscard]] std::string decoded(std::string_view text, bool raw) const {
    const std::size_t size = long_headers_ ? 8 : 4;
    const auto take = [&](std::size_t from, std::size_t bytes) {  // in the text
      const std::size_t length = raw ? bytes : (bytes + 2) / 3 * 4;
      if (from > text.size() || length > text.size() - from) refuse(name_, "the data of an array are cut");
      const auto part = text.substr(from, length);
      return std::pair(raw ? std::string(part) : from_base64(part), from + length);
    };
    const auto header = [&](std::string_view bytes, std::size_t i) {
      if ((i + 1) * size > bytes.size()) refuse(name_, "the data of an array are cut");
      return static_cast<std::size_t>(long_headers_ ? value_at<std::uint64_t>(bytes, i, swapped_)
                                                    : value_at<std::uint32_t>(bytes, i, swapped_));
    };
    const std::size_t first = header(take(0, size).first, 0);
    if (first > (std::size_t{1} << 40)) refuse(name_, "the size of an array makes no sense");
    if (compressor_.empty()) {
      const std::string all = take(0, size + first).first;
      if (all.size() < size + first) refuse(name_, "the data of an array are cut");
      return all.substr(size, first);
    }
    const auto [sizes, begin] = take(0, (3 + first) * size);
    std::size_t compressed = 0;
    for (std::size_t block = 0; block < first; ++block) compressed += header(sizes, 3 + block);
    const std::string data = take(begin, compressed).first;
    if (data.size() < compressed) refuse(name_, "the data of an array are cut");
    std::string result;
    std::size_t at = 0;
    for (std::size_t block = 0; block < first; ++block) {
      const std::size_t last = header(sizes, 2);
      std::string part(block + 1 == first && last > 0 ? last : header(sizes, 1), '\0');
      auto length = static_cast<uLongf>(part.size());
      const std::size_t from = header(sizes, 3 + block);
      if (uncompress(reinterpret_cast<Bytef*>(part.data()), &length,
                     reinterpret_cast<const Bytef*>(data.data() + at), from) != Z_OK)
        refuse(name_, "the compressed data of an array are damaged");
      result.append(part, 0, length);
      at += from;
    }
    return result;
  }

  std::string name_;
  char direction_;
  Tree tree_;
  const Tree* file_ = nullptr;
  std::string appended_;
  bool raw_ = false;
  bool swapped_ = false;
  bool long_headers_ = false;
  std::string compressor_;
};

std::string table_of_vtk(const std::string& name, const std::string& text, char direction) {
  constexpr std::size_t all = std::string::npos;
  const VtkReader reader(name, text, direction);
  std::string table;
  if (reader.is_series()) {
    for (const auto& [time, file] : reader.parts()) {
      const std::string part = (fs::path(name).parent_path() / file).string();
      VtkReader(part, contents(part, all), direction).add_rows(table, time);
    }
  } else {
    reader.add_rows(table, "");
  }
  if (table.empty()) refuse(name, "there are no particles in it");
  return table;
}

// --- LAMMPS
// ------------------------------------------------------------------------------------------------------

std::string table_of_dump(const std::string& name, const std::string& text, double step) {
  std::string table;
  std::string header;
  std::string time;
  bool counts = false;  // steps, not seconds
  std::istringstream lines(text);
  std::string line;
  bool atoms = false;
  while (std::getline(lines, line)) {
    if (line.ends_with('\r')) line.pop_back();
    std::istringstream words(line);
    std::string word;
    if (!line.starts_with("ITEM:")) {
      if (!atoms) continue;
      table += time;
      while (words >> word) table += "," + word;
      table += "\n";
      continue;
    }
    atoms = line.starts_with("ITEM: ATOMS");
    if (atoms) {
      std::string columns = "time";
      words >> word >> word;
      while (words >> word) columns += "," + word;
      if (header.empty()) table = header = columns + "\n";
      if (header != columns + "\n") refuse(name, "its columns change: " + line);
    } else if (line == "ITEM: TIME") {
      std::getline(lines, time);
      counts = false;
    } else if (line == "ITEM: TIMESTEP") {
      std::getline(lines, line);
      double count = 0.0;
      std::from_chars(line.data(), line.data() + line.size(), count);
      time = number(count * step);
      counts = true;
    }
    if (atoms && counts && step <= 0.0)
      refuse(name, "this dump counts steps: --time-step T says how long one is");
  }
  if (header.empty()) refuse(name, "there is no ITEM: ATOMS in this dump");
  return table;
}

}  // namespace

TableFile::TableFile(const std::string& name, char direction, double step)
    : name_(name == "-" ? "standard input" : name), path_(name) {
  constexpr std::size_t all = std::string::npos;
  std::error_code none;
  const bool again = fs::is_regular_file(name, none);  // can be read again
  std::array<char, 2> magic{};
  if (again) std::ifstream(name, std::ios::binary).read(magic.data(), 2);
  const bool compressed = magic[0] == '\x1f' && magic[1] == '\x8b';
  std::string text = contents(name, again && !compressed ? 1 << 12 : all);
  refuse_others(name_, text);
  const auto first = text.find_first_not_of(" \t\r\n");
  const auto begins = [&](std::string_view with) {
    return first != text.npos && std::string_view(text).substr(first).starts_with(with);
  };
  const bool vtk = begins("<");
  const bool dump = begins("ITEM:");
  if (again && !compressed && (vtk || dump)) text = contents(name, all);
  if (vtk)
    spool(table_of_vtk(name_, text, direction));
  else if (dump)
    spool(table_of_dump(name_, text, step));
  else if (!again || compressed)
    spool(text);
}

void TableFile::spool(const std::string& text) {
  file_.reset(std::tmpfile());  // NOLINT(cppcoreguidelines-owning-memory): it does own it
  if (!file_ || std::fwrite(text.data(), 1, text.size(), file_.get()) != text.size() ||
      std::fflush(file_.get()) != 0)
    throw FileError("write a temporary file for", name_, errno);
  path_ = "/proc/self/fd/" + std::to_string(::fileno(file_.get()));
}

}  // namespace hompm::cli
