// Pictures as scripts for gnuplot, the data inside: what all of them share. Lengths on the page are in px of
// 1/96 inch.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

namespace hompm::gnuplot {

/// A line, dots, or both.
struct Stroke {
  std::string colour;  ///< "#0072B2"
  int dash = 1;        ///< of the line, as gnuplot counts
  int shape = 7;       ///< of the dots, as gnuplot counts
  double width = 0.0;  ///< of the line; none at 0
  double size = 0.0;   ///< of the dots; none at 0
};

/// How a scheme is drawn in every picture, without width and size. One that is not in the table is grey.
Stroke scheme_stroke(const std::string& scheme);

/// The colour, lighter (part < 0, white at −1) or darker (part > 0, black at 1).
std::string shade(const std::string& colour, double part);

/// The value in some decimal digits, the same in every locale.
std::string digits(double value, int count = 5);
/// The value in a unit that leaves it few digits: "20 ms".
std::string readable(double value, const std::string& unit);

/// Whole powers of ten around least … most, both positive.
struct Decades {
  double from, to;
  /// "set xrange [1e-4:10]"
  [[nodiscard]] std::string range(char axis) const;
};
Decades decades(double least, double most);

struct Curve {
  std::string title;  ///< in the legend; none when empty
  Stroke stroke;
  std::vector<double> x, y;  ///< what is not finite is left out
};

/// Values on an even grid, row by row, drawn in colours.
struct Image {
  double x, dx, y, dy;  ///< middle of the first pixel, distance of pixels
  std::size_t columns;
  std::vector<double> values;
};

struct Axis {
  std::string label;
  std::string unit = {};  ///< SI, to which a prefix is added where that leaves fewer digits
};

struct Panel {
  std::string title;
  Axis x, y;
  std::string settings = {};  ///< further lines of the script
  bool logarithmic = false;   ///< upwards; what is not positive is left out
  bool own_legend = false;    ///< above the panel instead of that of the page
  std::vector<Curve> curves = {};
  std::vector<Image> images = {};  ///< of one field, whose unit follows
  std::string image_unit = {};
  std::string note = {};  ///< a sentence in an empty panel
};

/// Panels in rows, with letters; above them title and legend. Nothing lies over the data.
struct Picture {
  std::string title;
  std::size_t columns = 3;
  double panel_width = 214.0;  ///< three of them fit the text of an A4 or letter page
  double panel_height = 198.0;
  std::vector<Panel> panels = {};
};

/// Endings of files that gnuplot writes.
inline constexpr std::string_view endings[] = {".svg", ".png", ".pdf"};

/// The script, which writes into the file `output`, or to standard output when it is empty; `ending` is one
/// of `endings`.
std::string script(const Picture& picture, std::string_view ending, const std::string& output);

}  // namespace hompm::gnuplot
