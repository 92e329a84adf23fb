#include <umov/io/plot_page.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <fmt/format.h>
#include <umov/core/quantity.h>

#include <umov/picture/colours.h>

// Drawn here and not by a plotting library: figures of `umov paper` and docs/pictures come out of
// the binary alone and the same to the byte on every machine; plotly's own SVG export wants a
// browser.

namespace umov {
namespace {

constexpr double width = 640, height = 440;
constexpr double left = 74, right = 622, top = 34, bottom = 352;

/// Values shown along one axis.
struct Range {
  double low = std::numeric_limits<double>::infinity(),
         high = -std::numeric_limits<double>::infinity();
  bool is_log = false;

  void take(double v) {
    if (!std::isfinite(v) || (is_log && v <= 0))
      return;
    low = std::min(low, scale(v));
    high = std::max(high, scale(v));
  }
  void finish() {
    if (!(low <= high))
      low = 0, high = 1;
    const double pad = high > low ? 0.03 * (high - low) : std::max(1e-9, 0.05 * std::abs(high));
    low -= pad;
    high += pad;
  }
  [[nodiscard]] double scale(double v) const { return is_log ? std::log10(v) : v; }
  [[nodiscard]] double place(double v, double from, double to) const {
    return from + (scale(v) - low) / (high - low) * (to - from);
  }
};

struct Tick {
  double value;
  std::string text;
};

std::vector<Tick> ticks(const Range &range) {
  std::vector<Tick> out;
  if (range.is_log) {
    const double decades = range.high - range.low;
    const double step = std::max(1.0, std::ceil(decades / 7));
    for (double k = std::ceil(range.low); k <= range.high; k += step)
      out.push_back({std::pow(10, k), fmt::format("1e{:.0f}", k == 0 ? 0 : k)});
    if (out.size() >= 2)
      return out;
    out.clear();
    for (const double v :
         {std::pow(10, range.low + 0.1 * decades), std::pow(10, range.high - 0.1 * decades)})
      out.push_back({v, fmt::format("{:.2g}", v)});
    return out;
  }
  const double raw = (range.high - range.low) / 6;
  const double power = std::pow(10, std::floor(std::log10(raw)));
  double step = power;
  for (const double factor : {2., 5., 10.})
    if (step < raw)
      step = factor * power;
  for (double k = std::ceil(range.low / step); k * step <= range.high; ++k) {
    const double value = k == 0 ? 0 : k * step;
    out.push_back({value, fmt::format("{:.6g}", value)});
  }
  return out;
}

std::string escaped(const std::string &text) {
  std::string out;
  for (const char c : text)
    out += c == '<' ? "&lt;" : c == '>' ? "&gt;" : c == '&' ? "&amp;" : std::string(1, c);
  return out;
}

std::string label(double x, double y, const char *anchor, const std::string &text,
                  const char *more = "") {
  return fmt::format("<text x=\"{:.1f}\" y=\"{:.1f}\" text-anchor=\"{}\" {}>{}</text>\n", x, y,
                     anchor, more, escaped(text));
}

const char *dash_of(const std::string &name) {
  if (name == "dash")
    return " stroke-dasharray=\"7 4\"";
  if (name == "dot")
    return " stroke-dasharray=\"2 3\"";
  return name == "dashdot" ? " stroke-dasharray=\"8 3 2 3\"" : "";
}

struct Point {
  double x = 0, y = 0;
  [[nodiscard]] bool is_there() const { return std::isfinite(x) && std::isfinite(y); }
};

/// A marker of its line's own shape: colour is not all that tells lines apart.
std::string marker(Point p, std::size_t shape, const std::string &colour) {
  constexpr double r = 2;
  if (shape % 3 == 1)
    return fmt::format("<rect x=\"{:.2f}\" y=\"{:.2f}\" width=\"{}\" height=\"{}\" fill=\"{}\"/>\n",
                       p.x - r, p.y - r, 2 * r, 2 * r, colour);
  if (shape % 3 == 2)
    return fmt::format("<path d=\"M{:.2f} {:.2f}l{} {}l{} {}l{} {}z\" fill=\"{}\"/>\n", p.x,
                       p.y - 1.4 * r, 1.4 * r, 1.4 * r, -1.4 * r, 1.4 * r, -1.4 * r, -1.4 * r,
                       colour);
  return fmt::format("<circle cx=\"{:.2f}\" cy=\"{:.2f}\" r=\"{}\" fill=\"{}\"/>\n", p.x, p.y, r,
                     colour);
}

std::string draw(const PlotLine &line, std::size_t index, const std::vector<Point> &points) {
  const std::string colour = plot_colour(line.colour);
  std::string out;
  if (line.has_markers) {
    for (const Point p : points)
      if (p.is_there())
        out += marker(p, index, colour);
    return out;
  }
  std::string path;
  bool is_open = false;
  for (const Point p : points) {
    if (p.is_there())
      path += fmt::format("{}{:.2f} {:.2f}", is_open ? "L" : "M", p.x, p.y);
    is_open = p.is_there();
  }
  return fmt::format("<path d=\"{}\" fill=\"none\" stroke=\"{}\" stroke-width=\"1.8\"{}/>\n", path,
                     colour, dash_of(line.dash));
}

std::string legend(const PlotFigure &figure) {
  std::string out;
  double x = left, y = bottom + 56;
  for (std::size_t i = 0; i < figure.lines.size(); ++i) {
    const PlotLine &line = figure.lines[i];
    const double wide = 40 + 5.6 * static_cast<double>(line.name.size());
    if (x + wide > right + 10 && x > left) {
      x = left;
      y += 15;
    }
    if (y > height - 4)
      break; // the page has the rest
    out += draw(line, i,
                line.has_markers ? std::vector<Point>{{x + 11, y - 4}}
                                 : std::vector<Point>{{x, y - 4}, {x + 22, y - 4}});
    out += label(x + 27, y, "start", line.name, "font-size=\"11\"");
    x += wide;
  }
  return out;
}

std::string plane(const PlotFigure &figure) {
  Range x, y;
  x.is_log = figure.has_log_x;
  y.is_log = figure.has_log_y;
  for (const PlotLine &line : figure.lines) {
    for (const double v : line.x)
      x.take(v);
    for (const double v : line.y)
      y.take(v);
  }
  x.finish();
  y.finish();
  std::string out;
  for (const Tick &t : ticks(x)) {
    const double at = x.place(t.value, left, right);
    out += fmt::format("<path d=\"M{0:.1f} {1}V{2}\" stroke=\"#e3e7ec\"/>\n", at, top, bottom);
    out += label(at, bottom + 16, "middle", t.text);
  }
  for (const Tick &t : ticks(y)) {
    const double at = y.place(t.value, bottom, top);
    out += fmt::format("<path d=\"M{1} {0:.1f}H{2}\" stroke=\"#e3e7ec\"/>\n", at, left, right);
    out += label(left - 6, at + 4, "end", t.text);
  }
  out += fmt::format("<path d=\"M{0} {1}V{2}H{3}\" fill=\"none\" stroke=\"#566072\"/>\n", left, top,
                     bottom, right);
  for (std::size_t i = 0; i < figure.lines.size(); ++i) {
    const PlotLine &line = figure.lines[i];
    std::vector<Point> points;
    for (std::size_t k = 0; k < std::min(line.x.size(), line.y.size()); ++k) {
      const bool is_shown = (!y.is_log || line.y[k] > 0) && (!x.is_log || line.x[k] > 0);
      constexpr double nowhere = std::numeric_limits<double>::quiet_NaN();
      points.push_back(is_shown
                           ? Point{x.place(line.x[k], left, right), y.place(line.y[k], bottom, top)}
                           : Point{nowhere, nowhere});
    }
    out += draw(line, i, points);
  }
  out += label((left + right) / 2, bottom + 36, "middle", figure.x_title);
  out +=
      label(0, 0, "middle", figure.y_title,
            fmt::format("transform=\"translate(18 {}) rotate(-90)\"", (top + bottom) / 2).c_str());
  return out;
}

/// Sky overhead: zenith in the middle, north up, east left.
std::string sky(const PlotFigure &figure) {
  constexpr double x0 = width / 2, y0 = (top + bottom) / 2 + 8, radius = (bottom - top) / 2 - 8;
  std::string out;
  for (const double share : {1 / 3., 2 / 3., 1.})
    out += fmt::format("<circle cx=\"{}\" cy=\"{}\" r=\"{:.1f}\" fill=\"none\" "
                       "stroke=\"#d3d9e1\"/>\n",
                       x0, y0, share * radius);
  out += label(x0, y0 - radius - 5, "middle", "N") + label(x0 - radius - 8, y0 + 4, "end", "E") +
         label(x0, y0 + radius + 16, "middle", "S") + label(x0 + radius + 8, y0 + 4, "start", "W");
  for (std::size_t i = 0; i < figure.lines.size(); ++i) {
    std::vector<Point> points;
    for (std::size_t k = 0; k < figure.lines[i].x.size(); ++k) {
      const double r = (90 - figure.lines[i].y[k]) / 90 * radius,
                   a = figure.lines[i].x[k] * pi / 180;
      points.push_back({x0 - r * std::sin(a), y0 - r * std::cos(a)});
    }
    out += draw(figure.lines[i], i, points);
  }
  return out;
}

/// Seen from (1.6, -1.6, 0.9), parallel rays, each axis scaled to the same length.
std::string space(const PlotFigure &figure) {
  std::array<Range, 3> axis;
  for (const PlotLine &line : figure.lines)
    for (std::size_t k = 0; k < line.x.size(); ++k) {
      axis[0].take(line.x[k]);
      axis[1].take(line.y[k]);
      axis[2].take(line.z[k]);
    }
  for (Range &range : axis)
    range.finish();
  constexpr double half = 0.70710678, sine = 0.37, cosine = 0.929; // elevation 21.7 deg
  const auto project = [](double a, double b, double c) {          // of -0.5..0.5
    return Point{width / 2 + 220 * (half * a + half * b),
                 (top + bottom) / 2 + 10 - 220 * (cosine * c + sine * (half * b - half * a))};
  };
  const auto edge = [&](std::array<double, 3> from, std::array<double, 3> to) {
    const Point a = project(from[0], from[1], from[2]), b = project(to[0], to[1], to[2]);
    return fmt::format("<path d=\"M{:.1f} {:.1f}L{:.1f} {:.1f}\" stroke=\"#b8bfc9\"/>\n", a.x, a.y,
                       b.x, b.y);
  };
  constexpr double h = 0.5;
  std::string out = edge({-h, -h, -h}, {h, -h, -h}) + edge({h, -h, -h}, {h, h, -h}) +
                    edge({h, h, -h}, {h, h, h}) + edge({-h, -h, -h}, {-h, -h, h}) +
                    edge({-h, -h, h}, {h, -h, h}) + edge({h, -h, h}, {h, h, h}) +
                    edge({h, -h, -h}, {h, -h, h});
  for (std::size_t i = 0; i < figure.lines.size(); ++i) {
    const PlotLine &line = figure.lines[i];
    std::vector<Point> points;
    for (std::size_t k = 0; k < line.x.size(); ++k)
      points.push_back(project(axis[0].place(line.x[k], -h, h), axis[1].place(line.y[k], -h, h),
                               axis[2].place(line.z[k], -h, h)));
    out += draw(line, i, points);
  }
  const auto ends = [&](std::size_t k, std::array<double, 3> from, std::array<double, 3> to,
                        const std::string &title) {
    const Point a = project(from[0], from[1], from[2]), b = project(to[0], to[1], to[2]);
    return label(a.x, a.y, "middle", fmt::format("{:.3g}", axis[k].low), "font-size=\"11\"") +
           label(b.x, b.y, "middle", fmt::format("{:.3g}", axis[k].high), "font-size=\"11\"") +
           label((a.x + b.x) / 2, (a.y + b.y) / 2 + (k < 2 ? 16 : 0), k < 2 ? "middle" : "end",
                 title);
  };
  out += ends(0, {-0.45, -0.6, -0.55}, {0.4, -0.6, -0.55}, figure.x_title);
  out += ends(1, {0.6, -0.4, -0.55}, {0.6, 0.45, -0.55}, figure.y_title);
  out += ends(2, {-0.62, -0.5, -0.45}, {-0.62, -0.5, 0.45}, figure.z_title);
  return out;
}

} // namespace

std::string plot_svg(const PlotFigure &figure) {
  std::string out =
      fmt::format("<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {0} {1}\" width=\"{0}\" "
                  "height=\"{1}\" font-family=\"DejaVu Sans, Arial, sans-serif\" font-size=\"12\" "
                  "fill=\"#1b1f24\">\n<rect width=\"{0}\" height=\"{1}\" fill=\"#fff\"/>\n",
                  width, height);
  out += label(left, 20, "start", figure.title, "font-size=\"13\" font-weight=\"bold\"");
  out += figure.is_sky ? sky(figure) : figure.z_title.empty() ? plane(figure) : space(figure);
  return out + legend(figure) + "</svg>\n";
}

} // namespace umov
