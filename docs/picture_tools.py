"""Pages of panels for gnuplot, laid out as the pictures of hompm-run are (lib/hompm/kit/output/gnuplot.cpp): letters, titles and
labels at fixed places, legends beside the data, never over it."""
import math

LETTER, ROW, SAMPLE = 6.6, 15, 36  # width of a letter, height of a row and length of a sample in a legend, px


def quoted(text):
    return "'" + text.replace("'", "''") + "'"


def stroke(colour="#000000", width=0.0, dash=1, shape=7, size=0.0):
    return {"colour": colour, "width": width, "dash": dash, "shape": shape, "size": size}


def curve(title, look, rows):
    """Rows of numbers, or a function of x as gnuplot writes it."""
    return {"title": title, "look": look, "rows": rows}


def panel(title, x, y, curves, settings="", logarithmic=False):
    return {"title": title, "x": x, "y": y, "curves": curves, "settings": settings, "logarithmic": logarithmic}


def colour_of(look):
    return f" linecolor rgb '{look['colour']}'"


def line_of(look):
    return f" linewidth {look['width'] + 0.001 * look['dash']:.5g} dashtype {look['dash']}"  # SVG: a new dash needs a new width


def dots_of(look, size):
    return f" pointtype {look['shape']} pointsize {size:.5g}"


def style(look):
    words = {(True, False): "lines", (False, True): "points", (True, True): "linespoints"}[look["width"] > 0, look["size"] > 0]
    return f" with {words}" + colour_of(look) + (line_of(look) if look["width"] else "") + (dots_of(look, look["size"]) if look["size"] else "")


def legend_of(panels, width):
    """[(curve, x, row)] of the titles, each once."""
    entries = []
    for one in (each for part in panels for each in part["curves"]):
        if not one["title"] or any(one["title"] == other["title"] for other, _, _ in entries):
            continue
        x, row = (entries[-1][1] + SAMPLE + LETTER * len(entries[-1][0]["title"]), entries[-1][2]) if entries else (16, 0)
        if entries and x + SAMPLE + LETTER * len(one["title"]) > width:
            x, row = 16, row + 1
        entries.append((one, x, row))
    return entries


def decades(axis, values):
    """An axis of whole powers of ten around them."""
    low, high = (10.0 ** rounded(math.log10(value)) for rounded, value in ((math.floor, min(values)), (math.ceil, max(values))))
    return f"set logscale {axis}\nset format {axis} '10^{{%T}}'\nset {axis}range [{low:g}:{high:g}]\n"


def page(title, panels, columns=3, panel_width=276, panel_height=240, terminal="svg"):
    """The script of a page as wide as GitHub's text, 830 px."""
    width = columns * panel_width
    legend = legend_of(panels, width)
    head = 26 + (legend[-1][2] + 1) * ROW + 6 if legend else 26
    height = head + -(-len(panels) // columns) * panel_height
    size = {"svg": f"svg size {width},{height} font 'Helvetica,11'",
            "png": f"pngcairo size {2 * width},{2 * height} font 'Helvetica,8.25' fontscale 2 linewidth 2 pointscale 2"}[terminal]

    def at(x, y):
        return f"screen {x / width:.5g},screen {1 - y / height:.5g}"

    def text(x, y, words, how):
        return f"set label {quoted(words)} at {at(x, y)} {how} noenhanced\n"

    script = (f"set encoding utf8\nset terminal {size} background '#FFFFFF'\nset tics nomirror\nset border 3 linecolor rgb '#404040'\n"
              "set grid linecolor rgb '#E0E0E0' linetype 1\nunset key\nset multiplot\n" + text(width / 2, 12, title, "center"))
    for one, x, row in legend:
        look, y = one["look"], 22 + ROW * (row + 0.5)
        if look["width"]:
            script += f"set arrow from {at(x, y)} to {at(x + 20, y)} nohead{colour_of(look)}{line_of(look)}\n"
        if look["size"]:
            script += text(x + 10, y, "", "point" + colour_of(look) + dots_of(look, max(look["size"], 0.5)))
        script += text(x + 24, y, one["title"], "left")
    for number, part in enumerate(panels):
        left, top = number % columns * panel_width, head + number // columns * panel_height
        right, bottom = left + panel_width - 18, top + panel_height
        middle = (left + 52 + right) / 2
        above = 19 if part["title"] else 6
        script += "\nset xrange [*:*] noreverse\nset yrange [*:*]\nunset logscale\nset format '%g'\nset xtics autofreq\nset ytics autofreq\n"
        script += text(left + 2, top + 8, f"({chr(97 + number)})", "left") if len(panels) > 1 else ""
        script += text(middle, top + 8, part["title"], "center") + text(middle, bottom - 9, part["x"], "center")
        script += text(left + 7, (top + above + bottom - 42) / 2, part["y"], "center rotate by 90")
        for side, place in (("l", (left + 52) / width), ("r", right / width), ("t", 1 - (top + above) / height), ("b", 1 - (bottom - 42) / height)):
            script += f"set {side}margin at screen {place:.5g}\n"
        plots = []
        for index, one in enumerate(part["curves"]):
            if isinstance(one["rows"], str):
                plots.append(one["rows"] + style(one["look"]) + " notitle")
            elif one["rows"]:
                name = f"$p{number}c{index}"
                rows = (" ".join(f"{value:.5g}" if isinstance(value, float) else str(value) for value in row) for row in one["rows"])
                script += "\n".join([f"{name} << EOD", *rows, "EOD", ""])
                plots.append(f"{name} using 1:2{style(one['look'])} notitle")
        script += "set logscale y\nset format y '10^{%T}'\n" if part["logarithmic"] else ""
        script += part["settings"] + "\nplot " + ", ".join(plots) + "\nunset label\nunset arrow\nunset object\n"
    return script + "unset multiplot\n"
