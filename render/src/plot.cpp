#include "render/plot.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "canvas.hpp"
#include "render/context.hpp"
#include "target.hpp"
#include "theme.hpp"
#include "ticks.hpp"

namespace render {
namespace {

// One axis: from values to a fraction of its length.
struct Axis {
  Scale scale = Scale::linear;
  double low = 0, high = 1;

  bool shows(double v) const { return std::isfinite(v) && (scale == Scale::linear || v > 0); }
  double fraction(double v) const {
    if (scale == Scale::log) return std::log(v / low) / std::log(high / low);
    return (v - low) / (high - low);
  }
};

// Low above high where there is no value to show.
struct Extent {
  double low = std::numeric_limits<double>::infinity();
  double high = -std::numeric_limits<double>::infinity();
  bool empty() const { return low > high; }
  void add(double v) {
    low = std::min(low, v);
    high = std::max(high, v);
  }
};

// Whether a curve may touch the ends of its axis.
enum class Ends { tight, loose };

Axis fit_axis(Scale scale, Extent e, Ends ends) {
  Axis axis;
  axis.scale = scale;
  if (scale == Scale::log) {
    if (e.empty()) e = {1, 10};
    if (e.high > e.low) {
      const double pad = ends == Ends::loose ? std::pow(e.high / e.low, 0.04) : 1;
      axis.low = std::max(e.low / pad, std::numeric_limits<double>::min());
      axis.high = std::min(e.high * pad, std::numeric_limits<double>::max());
    } else {
      axis.low = std::max(e.low / 10, std::numeric_limits<double>::min());
      axis.high = std::min(e.high * 10, std::numeric_limits<double>::max());
    }
    return axis;
  }
  if (e.empty()) e = {0, 1};
  const double limit = std::numeric_limits<double>::max() / 8;  // so that high - low is finite
  e.low = std::clamp(e.low, -limit, limit);
  e.high = std::clamp(e.high, -limit, limit);
  const double size = std::max(std::abs(e.low), std::abs(e.high));
  if (!(e.high - e.low > 1e-11 * size)) {  // constant, but for rounding
    const double half = size > 0 ? size / 2 : 1;
    return {scale, e.low - half, e.high + half};
  }
  if (ends == Ends::tight) return {scale, e.low, e.high};
  // Curves that come near zero are shown from zero.
  if (e.low >= 0 && e.low < 0.35 * e.high) e.low = 0;
  if (e.high <= 0 && e.high > 0.35 * e.low) e.high = 0;
  const double pad = 0.05 * (e.high - e.low);
  return {scale, e.low == 0 ? 0 : e.low - pad, e.high == 0 ? 0 : e.high + pad};
}

struct Axes {
  Axis x, y;
  Ticks x_ticks, y_ticks;
  Rect area;  // of the curves

  Point pixel(double vx, double vy) const {
    return {area.x0 + static_cast<float>(x.fraction(vx)) * area.width(),
            area.y1 - static_cast<float>(y.fraction(vy)) * area.height()};
  }
};

Ticks ticks_of(const Axis& axis, int most) {
  return axis.scale == Scale::log ? log_ticks(axis.low, axis.high, most)
                                  : linear_ticks(axis.low, axis.high, most);
}

float series_width(const Canvas& canvas, std::size_t k) {
  return (k % 2 == 0 ? 2.6f : 2.1f) * std::max(canvas.unit(), 0.75f);
}

Color series_color(std::size_t k) {
  return theme::series[k % theme::series.size()];
}

float series_dash(const Canvas& canvas, std::size_t k) {
  static constexpr std::array<float, 4> periods{0, 15, 8, 24};
  return periods[k % periods.size()] * std::max(canvas.unit(), 0.75f);
}

std::string all_text(const Plot& plot) {
  std::string text = plot.title + plot.x_label + plot.y_label;
  for (const Series& s : plot.series) text += s.name;
  return text;
}

// Many points in one column of pixels: the first, the lowest, the highest and the last of them draw the same
// line.
void thin_out(std::vector<Point>& points, float picture_width) {
  if (points.size() < 8 * static_cast<std::size_t>(picture_width)) return;
  std::vector<Point> kept;
  std::size_t i = 0;
  while (i < points.size()) {
    std::size_t end = i, low = i, high = i;
    for (; end < points.size() && std::floor(points[end].x) == std::floor(points[i].x); ++end) {
      if (points[end].y < points[low].y) low = end;
      if (points[end].y > points[high].y) high = end;
    }
    std::array<std::size_t, 4> four{i, std::min(low, high), std::max(low, high), end - 1};
    for (std::size_t k = 0; k < 4; ++k) {
      if (k == 0 || four[k] != four[k - 1]) kept.push_back(points[four[k]]);
    }
    i = end;
  }
  points = std::move(kept);
}

class PlotPainter {
 public:
  PlotPainter(Canvas& canvas, const Plot& plot) : canvas_(canvas), plot_(plot) {
    text_ = canvas.text_size(TextSize::small);
    thin_ = std::max(1.0f, canvas.unit());
    fit();
  }

  void draw() {
    draw_grid();
    draw_axes();
    for (std::size_t k = 0; k < plot_.series.size(); ++k) draw_series(k);
    if (!legend_.empty()) draw_legend();
    const float title_y = margin() + canvas_.text_size(TextSize::title) / 2;
    canvas_.text({margin(), title_y}, Align::left, TextSize::title, theme::ink, fitting_title());
  }

 private:
  struct Entry {
    std::size_t series;
    Point at;
  };

  // Of "whose: what" too long for the picture, `whose` is cut.
  std::string fitting_title() const {
    const float room = static_cast<float>(canvas_.width()) - 2 * margin();
    const std::size_t colon = plot_.title.rfind(": ");
    if (colon != std::string::npos && canvas_.text_width(TextSize::title, plot_.title) > room) {
      const std::string what = plot_.title.substr(colon);
      const std::string whose = canvas_.fit(TextSize::title, plot_.title.substr(0, colon),
                                            room - canvas_.text_width(TextSize::title, what));
      if (!whose.empty()) return whose + what;
    }
    return canvas_.fit(TextSize::title, plot_.title, room);
  }

  float margin() const { return 1.1f * canvas_.text_size(TextSize::normal); }
  float sample() const { return 2.4f * text_; }  // length of a line in the legend

  void fit() {
    Extent ex, ey;
    axes_.x.scale = plot_.x_scale;
    axes_.y.scale = plot_.y_scale;
    for (const Series& s : plot_.series) {
      for (std::size_t i = 0; i < std::min(s.x.size(), s.y.size()); ++i) {
        if (!axes_.x.shows(s.x[i]) || !axes_.y.shows(s.y[i])) continue;
        ex.add(s.x[i]);
        ey.add(s.y[i]);
      }
    }
    // A curve over time fills the width; points on a logarithmic axis keep clear of its ends.
    const bool points = plot_.x_scale == Scale::log &&
                        std::ranges::any_of(plot_.series, [](const Series& s) { return s.markers; });
    axes_.x = fit_axis(plot_.x_scale, ex, points ? Ends::loose : Ends::tight);
    axes_.y = fit_axis(plot_.y_scale, ey, Ends::loose);

    const auto w = static_cast<float>(canvas_.width()), h = static_cast<float>(canvas_.height());
    const float normal = canvas_.text_size(TextSize::normal);
    float top = margin() + (plot_.title.empty() ? 0 : canvas_.text_size(TextSize::title) + 0.6f * normal);
    top = place_legend(top);
    top_ = top;
    float bottom = h - margin() - (plot_.x_label.empty() ? 0 : 1.5f * normal) - 1.7f * text_;
    // Low pictures: the name of the axis beside its numbers.
    name_beside_ = !plot_.x_label.empty() && bottom - top < 6 * text_;
    if (name_beside_) bottom += 1.5f * normal;
    axes_.y_ticks = ticks_of(axes_.y, std::clamp(static_cast<int>((bottom - top) / (2.2f * text_)), 2, 9));
    if (axes_.y_ticks.exponent != 0) top += 0.9f * text_;
    float numbers = 0;
    for (const std::string& s : axes_.y_ticks.labels)
      numbers = std::max(numbers, canvas_.label_width(TextSize::small, s));
    const float left = margin() + (plot_.y_label.empty() ? 0 : 1.4f * normal) + numbers + 0.6f * text_;
    axes_.area = {std::round(left), std::round(top + 0.4f * text_), std::round(w - 1.6f * margin()),
                  std::round(bottom)};
    if (axes_.area.width() < 4 || axes_.area.height() < 4) axes_.area = {left, top, left + 4, top + 4};
    const int most = std::clamp(static_cast<int>(axes_.area.width() / (4.5f * text_)), 2, 11);
    axes_.x_ticks = ticks_of(axes_.x, most);
    // More of them where the axis' name beside them would leave but one.
    for (int more = 1; more < 4 && numbers_left() < 2; ++more) axes_.x_ticks = ticks_of(axes_.x, most + more);
    keep_apart(axes_.y_ticks, [&](std::size_t i) {
      const float y = axes_.pixel(axes_.x.low, axes_.y_ticks.at[i]).y;
      return std::array<float, 2>{y - 0.6f * text_, y + 0.6f * text_};
    });
    keep_apart(axes_.x_ticks, [&](std::size_t i) {
      const float x = axes_.pixel(axes_.x_ticks.at[i], axes_.y.low).x;
      const float half = canvas_.label_width(TextSize::small, axes_.x_ticks.labels[i]) / 2 + 0.3f * text_;
      return std::array<float, 2>{x - half, x + half};
    });
  }

  float right_end() const { return static_cast<float>(canvas_.width()) - 0.5f * margin(); }

  // How far to the right numbers may reach below the x axis.
  float numbers_end() const {
    if (!name_beside_) return static_cast<float>(canvas_.width());
    return right_end() - canvas_.label_width(TextSize::small, x_name()) - 0.5f * text_;
  }
  bool has_room(std::size_t x_tick) const {
    const float half = canvas_.label_width(TextSize::small, axes_.x_ticks.labels[x_tick]) / 2;
    return axes_.pixel(axes_.x_ticks.at[x_tick], axes_.y.low).x + half <= numbers_end();
  }
  std::size_t numbers_left() const {
    std::size_t n = 0;
    for (std::size_t i = 0; i < axes_.x_ticks.at.size(); ++i) n += has_room(i) ? 1 : 0;
    return n;
  }

  // Every second, every third, ... label where all would touch each other; `reach`: from where to where.
  template <class Reach>
  static void keep_apart(Ticks& ticks, const Reach& reach) {
    const auto touch = [&](std::size_t every) {
      for (std::size_t i = every; i < ticks.at.size(); i += every) {
        const auto a = reach(i - every), b = reach(i);
        if (a[0] < b[1] && b[0] < a[1]) return true;
      }
      return false;
    };
    std::size_t every = 1;
    while (touch(every)) ++every;
    for (std::size_t i = 0; i < ticks.at.size(); ++i)
      if (i % every != 0) ticks.labels[i].clear();
  }

  // In units of what the exponent says; on the numbers' line its left end.
  std::string x_name() const {
    if (axes_.x_ticks.exponent == 0) return plot_.x_label;
    return fmt::format("{} ×10^{}", plot_.x_label, axes_.x_ticks.exponent);
  }

  // Entries from left to right, in as many lines as needed; returns where the next thing below may begin.
  float place_legend(float top) {
    const float right = static_cast<float>(canvas_.width()) - margin();
    float x = margin(), y = top + 0.5f * text_;
    for (std::size_t k = 0; k < plot_.series.size(); ++k) {
      if (plot_.series[k].name.empty()) continue;
      const float width =
          sample() + 0.5f * text_ + canvas_.label_width(TextSize::small, plot_.series[k].name);
      if (x > margin() && x + width > right) {
        x = margin();
        y += 1.5f * text_;
      }
      legend_.push_back({k, {x, y}});
      x += width + 1.6f * text_;
    }
    return legend_.empty() ? top : y + 1.0f * text_;
  }

  void draw_legend() {
    for (const Entry& e : legend_) {
      const std::array<Point, 2> line{e.at, Point{e.at.x + sample(), e.at.y}};
      if (plot_.series[e.series].line)
        canvas_.polyline(line, series_color(e.series), series_width(canvas_, e.series),
                         series_dash(canvas_, e.series));
      if (plot_.series[e.series].markers) marker({e.at.x + sample() / 2, e.at.y}, e.series);
      canvas_.label({e.at.x + sample() + 0.5f * text_, e.at.y}, Align::left, TextSize::small, theme::ink,
                    plot_.series[e.series].name);
    }
  }

  void draw_grid() {
    const Rect& a = axes_.area;
    const auto vertical = [&](double v, Color color, float width, float dash) {
      const float x = std::round(axes_.pixel(v, axes_.y.low).x);
      const std::array<Point, 2> line{Point{x, a.y1}, Point{x, a.y0}};
      canvas_.polyline(line, color, width, dash);
    };
    for (const double v : axes_.x_ticks.at) vertical(v, theme::faint, thin_, 0);
    for (const double v : axes_.y_ticks.at) {
      const float y = std::round(axes_.pixel(axes_.x.low, v).y);
      canvas_.line({a.x0, y}, {a.x1, y}, theme::faint, thin_);
    }
    for (const double v : plot_.marks) {
      if (!axes_.x.shows(v) || v < axes_.x.low || v > axes_.x.high) continue;
      Color color = theme::soft_ink;
      color.a = 170;
      vertical(v, color, 1.3f * thin_, 6 * canvas_.unit());
    }
  }

  void draw_axes() {
    const Rect& a = axes_.area;
    const float normal = canvas_.text_size(TextSize::normal), tick = 0.35f * text_;
    canvas_.line({a.x0, a.y0}, {a.x0, a.y1}, theme::soft_ink, 1.2f * thin_);
    canvas_.line({a.x0, a.y1}, {a.x1, a.y1}, theme::soft_ink, 1.2f * thin_);
    for (std::size_t i = 0; i < axes_.x_ticks.at.size(); ++i) {
      const float x = std::round(axes_.pixel(axes_.x_ticks.at[i], axes_.y.low).x);
      canvas_.line({x, a.y1}, {x, a.y1 + tick}, theme::soft_ink, thin_);
      if (!has_room(i)) continue;
      canvas_.label({x, a.y1 + 1.1f * text_}, Align::center, TextSize::small, theme::ink,
                    axes_.x_ticks.labels[i]);
    }
    for (std::size_t i = 0; i < axes_.y_ticks.at.size(); ++i) {
      const float y = std::round(axes_.pixel(axes_.x.low, axes_.y_ticks.at[i]).y);
      canvas_.line({a.x0 - tick, y}, {a.x0, y}, theme::soft_ink, thin_);
      canvas_.label({a.x0 - 0.6f * text_, y}, Align::right, TextSize::small, theme::ink,
                    axes_.y_ticks.labels[i]);
    }
    for (const double v : axes_.x_ticks.minor) {
      const float x = std::round(axes_.pixel(v, axes_.y.low).x);
      canvas_.line({x, a.y1}, {x, a.y1 + 0.55f * tick}, theme::soft_ink, thin_);
    }
    for (const double v : axes_.y_ticks.minor) {
      const float y = std::round(axes_.pixel(axes_.x.low, v).y);
      canvas_.line({a.x0 - 0.55f * tick, y}, {a.x0, y}, theme::soft_ink, thin_);
    }
    if (axes_.y_ticks.exponent != 0) {
      canvas_.label({a.x0, a.y0 - 0.8f * text_}, Align::left, TextSize::small, theme::ink,
                    fmt::format("×10^{}", axes_.y_ticks.exponent));
    }
    if (name_beside_) {
      canvas_.label({right_end(), a.y1 + 1.1f * text_}, Align::right, TextSize::small, theme::ink, x_name());
    } else {
      const float x_label_y = a.y1 + 1.9f * text_ + 0.7f * normal;
      if (axes_.x_ticks.exponent != 0) {
        canvas_.label({a.x1, x_label_y}, Align::right, TextSize::small, theme::ink,
                      fmt::format("×10^{}", axes_.x_ticks.exponent));
      }
      canvas_.label({(a.x0 + a.x1) / 2, x_label_y}, Align::center, TextSize::normal, theme::ink,
                    plot_.x_label);
    }
    draw_y_name();
  }

  // Upwards at the left, in the middle of its axis or as near as title, legend and the picture's end allow.
  void draw_y_name() {
    if (plot_.y_label.empty()) return;
    const float normal = canvas_.text_size(TextSize::normal);
    const float bottom = static_cast<float>(canvas_.height()) - 0.4f * margin();
    const TextSize size = canvas_.label_width(TextSize::normal, plot_.y_label) <= bottom - top_
                              ? TextSize::normal
                              : TextSize::small;
    const float half = canvas_.label_width(size, plot_.y_label) / 2;
    const float middle =
        std::clamp((axes_.area.y0 + axes_.area.y1) / 2, std::min(top_ + half, bottom - half), bottom - half);
    canvas_.label_upwards({margin() + 0.45f * normal, middle}, size, theme::ink, plot_.y_label);
  }

  void draw_series(std::size_t k) {
    const Series& s = plot_.series[k];
    std::vector<Point> run;
    const auto draw_run = [&] {
      if (run.size() == 1 && !s.markers) marker(run.front(), k);
      if (!s.line) run.clear();
      thin_out(run, axes_.area.width());
      canvas_.polyline(run, series_color(k), series_width(canvas_, k), series_dash(canvas_, k));
      run.clear();
    };
    for (std::size_t i = 0; i < std::min(s.x.size(), s.y.size()); ++i) {
      if (!axes_.x.shows(s.x[i]) || !axes_.y.shows(s.y[i])) {
        draw_run();  // a gap
        continue;
      }
      run.push_back(axes_.pixel(s.x[i], s.y[i]));
      if (s.markers) marker(run.back(), k);
    }
    draw_run();
  }

  void marker(Point p, std::size_t k) {
    const float radius = 4.2f * std::max(canvas_.unit(), 0.75f);
    canvas_.disk(p, radius + thin_, theme::paper);
    canvas_.disk(p, radius, series_color(k));
  }

  Canvas& canvas_;
  const Plot& plot_;
  Axes axes_;
  std::vector<Entry> legend_;
  float top_ = 0;  // of what is left by title and legend
  bool name_beside_ = false;
  float text_ = 0;
  float thin_ = 1;
};

}  // namespace

Image draw_plot(Context& context, const Plot& plot, std::vector<TextBox>* texts) {
  context.make_current();
  const Gl& gl = context.gl();
  const Target target(gl, context.width(), context.height());
  Canvas canvas(gl, context.width(), context.height(), all_text(plot));
  target.bind();
  gl.Disable(GL_SCISSOR_TEST);
  gl.ClearColor(theme::paper.r / 255.0f, theme::paper.g / 255.0f, theme::paper.b / 255.0f, 1.0f);
  gl.Clear(GL_COLOR_BUFFER_BIT);
  PlotPainter(canvas, plot).draw();
  canvas.flush();
  if (texts) *texts = canvas.texts();
  Image out;
  target.read(out);
  return out;
}

}  // namespace render
