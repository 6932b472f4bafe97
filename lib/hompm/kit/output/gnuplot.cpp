#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <cstdlib>

#include <hompm/kit/output/gnuplot.hpp>
#include <hompm/scheme/scheme.hpp>

namespace hompm::gnuplot {
namespace {

constexpr double line_height = 15.0;
constexpr double letter_width = 6.6;  // on average, of a wide font of 11 px

template <class... Count>
std::string formatted(double value, std::chars_format format, Count... count) {
  std::array<char, 40> text{};
  return {text.data(), std::to_chars(text.data(), text.data() + text.size(), value, format, count...).ptr};
}

/// In gnuplot's quotes, in which only the quote itself means anything, on one line.
std::string in_quotes(std::string_view text) {
  std::string word = "'";
  for (const char c : text) word += c == '\'' ? "''" : c >= 0 && c < ' ' ? " " : std::string(1, c);
  return word + "'";
}

double width_of(std::string_view text) {
  return letter_width *
         static_cast<double>(std::ranges::count_if(text, [](char c) { return (c & 0xC0) != 0x80; }));
}

std::string colour(const Stroke& stroke) { return " linecolor rgb '" + stroke.colour + "'"; }
std::string line(const Stroke& stroke) {
  // In an SVG a dash that changes is only taken with a width that does.
  return " linewidth " + digits(stroke.width + 0.001 * stroke.dash) + " dashtype " +
         std::to_string(stroke.dash);
}
std::string dots(const Stroke& stroke, double size) {
  return " pointtype " + std::to_string(stroke.shape) + " pointsize " + digits(size);
}

/// Titles of curves beside each other in as many rows as they take.
struct Legend {
  double left, right;
  struct Entry {
    const Curve* curve;
    double x;
    int row;
  };
  std::vector<Entry> entries = {};

  /// The titles that are not there yet.
  void add(const Panel& panel) {
    for (const Curve& curve : panel.curves) {
      if (curve.title.empty() ||
          std::ranges::any_of(entries, [&](const Entry& e) { return e.curve->title == curve.title; }))
        continue;
      constexpr double sample = 36.0;
      const Entry* const last = entries.empty() ? nullptr : &entries.back();
      Entry next{&curve, last ? last->x + sample + width_of(last->curve->title) : left, last ? last->row : 0};
      if (last && next.x + sample + width_of(curve.title) > right) next = {&curve, left, last->row + 1};
      entries.push_back(next);
    }
  }
  [[nodiscard]] double height() const {
    return entries.empty() ? 0.0 : line_height * (entries.back().row + 1);
  }
};

/// A place for texts, from its top left corner.
struct Page {
  double width, height;

  [[nodiscard]] std::string at(double x, double y) const {
    return "screen " + digits(x / width) + ",screen " + digits(1.0 - y / height);
  }
  [[nodiscard]] std::string text(double x, double y, const std::string& text, const std::string& how) const {
    return "set label " + in_quotes(text) + " at " + at(x, y) + " " + how + " noenhanced\n";
  }
  [[nodiscard]] std::string legend(const Legend& legend, double top) const {
    std::string all;
    for (const auto& [curve, x, row] : legend.entries) {
      const Stroke& stroke = curve->stroke;
      const double y = top + line_height * (row + 0.5);
      if (stroke.width > 0.0)
        all += "set arrow from " + at(x, y) + " to " + at(x + 20.0, y) + " nohead" + colour(stroke) +
               line(stroke) + "\n";
      if (stroke.size > 0.0)
        all += text(x + 10.0, y, "", "point" + colour(stroke) + dots(stroke, std::max(stroke.size, 0.5)));
      all += text(x + 24.0, y, curve->title, "left");
    }
    return all;
  }
};

/// A prefix by which values up to `largest` have few digits: kPa for 20000 Pa.
struct Prefix {
  double over = 1.0;
  std::string name;
};

Prefix prefix_of(double largest, const std::string& unit) {
  Prefix prefix;
  if (unit.empty() || !(largest > 0.0) || !std::isfinite(largest)) return prefix;
  constexpr std::string_view names[] = {"n", "µ", "m", "", "k", "M", "G"};
  std::size_t i = 3;
  for (; i < 6 && largest / prefix.over >= 100.0; ++i) prefix.over *= 1e3;
  for (; i > 0 && largest / prefix.over < 0.1; --i) prefix.over /= 1e3;
  prefix.name = names[i];
  return prefix;
}

/// What values lie between.
struct Extent {
  double least = HUGE_VAL, most = -HUGE_VAL;

  void add(double value) {  // passes over NaN
    if (value < least) least = value;
    if (value > most) most = value;
  }
  void add(const std::vector<double>& values) {
    for (const double value : values) add(value);
  }
  [[nodiscard]] Prefix prefix(const std::string& unit) const {
    return prefix_of(std::max(most, -least), unit);
  }
};

/// Marks along the X axis, few enough for their numbers to stand beside each other.
std::string marks(const Extent& x, double over) {
  const double length = (x.most - x.least) / over;
  if (!(length > 0.0) || !std::isfinite(length)) return "set xtics autofreq\n";
  const double power = decades(length, length).from;
  double step = 2.0 * power;
  for (const double part : {1.0, 0.5, 0.2})
    if (length <= 5.0 * part * power) step = part * power;
  return "set xtics " + digits(step) + "\n";
}

std::string labelled(const Axis& axis, const Prefix& prefix) {
  return axis.label + (axis.unit.empty() ? "" : ", " + prefix.name + axis.unit);
}

/// Its data and words behind `plot`.
std::string drawn(const Image& image, const Prefix& x, const Prefix& y, double over, const std::string& name,
                  std::string& data) {
  data += name + " << EOD";
  for (std::size_t i = 0; i < image.values.size(); ++i)
    data += (i % image.columns == 0 ? "\n" : " ") + digits(image.values[i] / over, 4);
  data += "\nEOD\n";
  const auto place = [](const char* index, double first, double step, double unit) {
    return "(" + digits(first / unit, 9) + "+" + index + "*" + digits(step / unit, 9) + ")";
  };
  return ", " + name + " matrix using " + place("$1", image.x, image.dx, x.over) + ":" +
         place("$2", image.y, image.dy, y.over) + ":3 with image notitle";
}

/// Colours around zero where both signs matter.
std::string palette(const Extent& z, double over) {
  const double least = std::min(z.least, 0.0) / over;
  const double most = std::max(z.most, 0.0) / over;
  const double bound = std::max(most, -least);
  const bool both = std::min(most, -least) >= 0.1 * bound;
  return "set palette defined (" +
         std::string(both ? "0 '#053061', 1 '#4393C3', 2 '#F7F7F7', 3 '#D6604D', 4 '#67001F'"
                          : "0 '#440154', 1 '#3B528B', 2 '#21918C', 3 '#5EC962', 4 '#FDE725'") +
         ")\nset cbrange [" + digits(both ? -bound : least) + ":" + digits(both ? bound : most) + "]\n";
}

/// One panel with its number among all, whose left top corner is given.
std::string drawn(const Page& page, const Panel& panel, std::size_t number, double left, double top,
                  double right, double bottom) {
  std::string text =
      "\nset autoscale\nunset logscale\nset format '%g'\nset offsets 0,0,graph "
      "0.06,graph 0.06\n";
  Extent x_extent, y_extent, z_extent;
  for (const Curve& curve : panel.curves) {
    x_extent.add(curve.x);
    y_extent.add(curve.y);
  }
  for (const Image& image : panel.images) {
    x_extent.add({image.x, image.x + image.dx * static_cast<double>(image.columns - 1)});
    const std::size_t rows = image.values.size() / image.columns;
    y_extent.add({image.y, image.y + image.dy * static_cast<double>(rows - 1)});
    z_extent.add(image.values);
  }
  const Prefix x = x_extent.prefix(panel.x.unit), y = y_extent.prefix(panel.y.unit),
               z = z_extent.prefix(panel.image_unit);

  // What stands around it.
  Legend legend{left + 16.0, right};
  if (panel.own_legend) legend.add(panel);
  const double middle = 0.5 * (left + 52.0 + right - 15.0);
  text +=
      page.text(left + 2.0, top + 8.0, std::string("(") + static_cast<char>('a' + number % 26) + ")", "left");
  text += page.text(middle, top + 8.0,
                    panel.title + (panel.images.empty() ? "" : ", " + z.name + panel.image_unit), "center");
  text += page.text(middle, bottom - 9.0, labelled(panel.x, x), "center");
  text += page.legend(legend, top + 14.0);
  top += 19.0 + legend.height() + (panel.images.empty() ? 0.0 : 34.0);
  bottom -= 42.0;
  text += page.text(left + 7.0, 0.5 * (top + bottom), labelled(panel.y, y), "center rotate by 90");
  left += 52.0;
  right -= 15.0;
  const auto margin = [&](const char* side, double part) {
    text += std::string("set ") + side + "margin at screen " + digits(part) + "\n";
  };
  margin("l", left / page.width);
  margin("r", right / page.width);
  margin("t", 1.0 - top / page.height);
  margin("b", 1.0 - bottom / page.height);

  // What is drawn in it.
  std::string plots;
  if (!panel.images.empty())
    text += palette(z_extent, z.over) + "set colorbox horizontal user origin " +
            page.at(left + 10.0, top - 24.0) + " size screen " + digits((right - left - 20.0) / page.width) +
            ",screen " + digits(8.0 / page.height) + "\nset offsets\nset autoscale fix\n";
  for (std::size_t i = 0; i < panel.images.size(); ++i)
    plots +=
        drawn(panel.images[i], x, y, z.over, "$p" + std::to_string(number) + "i" + std::to_string(i), text);
  Extent shown;
  for (std::size_t c = 0; c < panel.curves.size(); ++c) {
    auto [title, stroke, xs, ys] = panel.curves[c];
    if (stroke.width > 0.0 && ys.size() > 50) stroke.size = 0.0;  // dots would hide the line
    std::string rows;
    for (std::size_t i = 0; i < ys.size(); ++i) {
      if (!std::isfinite(xs[i]) || !std::isfinite(ys[i]) || (panel.logarithmic && !(ys[i] > 0.0))) continue;
      rows.append(digits(xs[i] / x.over)).append(" ").append(digits(ys[i] / y.over)).append("\n");
      shown.add(ys[i]);
    }
    if (rows.empty()) continue;  // gnuplot would stop
    const std::string name = "$p" + std::to_string(number) + "c" + std::to_string(c);
    const char* const with = stroke.width == 0.0 ? "points" : stroke.size == 0.0 ? "lines" : "linespoints";
    text.append(name).append(" << EOD\n").append(rows).append("EOD\n");
    plots.append(", ").append(name).append(" using 1:2 with ").append(with).append(colour(stroke));
    if (stroke.width > 0.0) plots += line(stroke);
    if (stroke.size > 0.0) plots += dots(stroke, stroke.size);
    plots += " notitle";
  }
  if (plots.empty()) {
    text += "set xrange [0:1]\nset yrange [0:1]\nset format ''\n";
    for (std::string note = panel.note; !note.empty(); top += line_height) {
      const std::size_t fits = static_cast<std::size_t>((right - left) / letter_width);
      const std::size_t cut = note.size() > fits ? std::min(note.rfind(' ', fits), note.size()) : note.size();
      text += page.text(left + 4.0, top + 20.0, note.substr(0, cut), "left");
      note.erase(0, cut + 1);
    }
    return text + "plot NaN\nunset label\nunset arrow\n";
  }
  if (panel.logarithmic)
    text +=
        "set logscale y\nset format y '10^{%T}'\nset offsets\n" + decades(shown.least, shown.most).range('y');
  return text + marks(x_extent, x.over) + panel.settings + "plot " + plots.substr(2) +
         "\nunset label\nunset arrow\n";
}

std::string terminal(std::string_view ending, double width, double height) {
  const auto size = [&](double scale) { return digits(scale * width, 6) + "," + digits(scale * height, 6); };
  if (ending == ".svg") return "svg size " + size(1.0) + " font 'Helvetica,11' background '#FFFFFF'";
  if (ending == ".png")  // 288 dots an inch
    return "pngcairo size " + size(3.0) +
           " font 'Helvetica,8.25' fontscale 3 linewidth 3 pointscale 3 background '#FFFFFF'";
  return "pdfcairo size " + size(1.0 / 96.0) + " font 'Helvetica,8.25' fontscale 0.8 pointscale 0.7";
}

}  // namespace

Stroke scheme_stroke(const std::string& scheme) {
  for (const Scheme& row : scheme_table())
    if (row.name == scheme) return {row.look.colour, row.look.dash, row.look.shape};
  return {"#808080"};
}

std::string shade(const std::string& colour, double part) {
  std::string text = "#";
  for (std::size_t i = 1; i < 7; i += 2) {
    const int value = std::stoi(colour.substr(i, 2), nullptr, 16);
    const int mixed = value + static_cast<int>(std::abs(part) * ((part < 0.0 ? 255 : 0) - value));
    text += {"0123456789ABCDEF"[mixed / 16], "0123456789ABCDEF"[mixed % 16]};
  }
  return text;
}

std::string digits(double value, int count) { return formatted(value, std::chars_format::general, count); }

std::string readable(double value, const std::string& unit) {
  const Prefix prefix = prefix_of(std::abs(value), unit);
  return digits(value / prefix.over, 3) + " " + prefix.name + unit;
}

std::string Decades::range(char axis) const {
  return std::string("set ") + axis + "range [" + digits(from) + ":" + digits(to) + "]\n";
}

Decades decades(double least, double most) {
  const auto power = [](double value, int more) {
    const std::string text = formatted(value, std::chars_format::scientific);
    const int exponent = std::atoi(text.c_str() + text.find('e') + 1) + (text.starts_with("1e") ? 0 : more);
    return std::strtod(("1e" + std::to_string(exponent)).c_str(), nullptr);
  };
  const Decades range{power(least, 0), power(most, 1)};
  return range.from < range.to ? range : Decades{range.from, 10.0 * range.from};
}

std::string script(const Picture& picture, std::string_view ending, const std::string& output) {
  const auto columns = static_cast<double>(picture.columns);
  Legend legend{16.0, columns * picture.panel_width};
  for (const Panel& panel : picture.panels)
    if (!panel.own_legend) legend.add(panel);
  const std::size_t rows = (picture.panels.size() + picture.columns - 1) / picture.columns;
  const double head = 26.0 + legend.height() + (legend.entries.empty() ? 0.0 : 6.0);
  const Page page{columns * picture.panel_width, head + static_cast<double>(rows) * picture.panel_height};
  std::string text = "set encoding utf8\nset terminal " + terminal(ending, page.width, page.height) + "\n";
  if (!output.empty()) text += "set output " + in_quotes(output) + "\n";
  text +=
      "set border 3 linecolor rgb '#404040'\nset tics nomirror\nset grid linecolor rgb '#E0E0E0' linetype 1\n"
      "unset key\nset multiplot\n";
  text += page.text(0.5 * page.width, 12.0, picture.title, "center") + page.legend(legend, 22.0);
  for (std::size_t i = 0; i < picture.panels.size(); ++i) {
    const double left = static_cast<double>(i % picture.columns) * picture.panel_width;
    const std::size_t row = i / picture.columns;
    const double top = head + static_cast<double>(row) * picture.panel_height;
    text +=
        drawn(page, picture.panels[i], i, left, top, left + picture.panel_width, top + picture.panel_height);
  }
  return text + "unset multiplot\nunset output\n";
}

}  // namespace hompm::gnuplot
