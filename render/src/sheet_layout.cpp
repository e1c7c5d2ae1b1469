#include "sheet_layout.hpp"

#include <algorithm>
#include <cmath>

#include "render/mesh_picture.hpp"
#include "sheet_grid.hpp"
#include "ticks.hpp"

namespace render {
namespace {

class Sheet {
 public:
  Sheet(const Canvas& canvas, const Rect& area, const std::array<double, 4>& bounds,
        std::span<const TractionArrows::Arrow> arrows, float label_room)
      : canvas_(canvas),
        area_(area),
        bounds_(bounds),
        arrows_(arrows),
        label_room_(label_room),
        text_(canvas.text_size(TextSize::small)),
        normal_(canvas.text_size(TextSize::normal)) {}

  // A grid for these times, and the scale that it gives the shapes.
  struct Choice {
    std::vector<std::string> times;
    float widest = 0;
    Grid grid;
    double scale = 0;
    bool cramped = false;
  };
  Choice choose(std::vector<std::string> times) const {
    Choice c;
    c.times = std::move(times);
    for (const std::string& time : c.times)
      c.widest = std::max(c.widest, canvas_.text_width(TextSize::small, time));
    const auto is_cramped = [&](const Rect& cell) {
      return cell.width() < c.widest + 0.8f * text_ || room(cell).height() < 1.0f * text_;
    };
    const auto scale = [&](const Rect& cell) { return framing(cell).fit(room(cell)).scale; };
    // Cells too small for their times are taken only where no grid has others.
    constexpr double penalty = 1e-6;
    c.grid = choose_grid(static_cast<int>(c.times.size()), area_, [&](const Rect& cell) {
      return is_cramped(cell) ? penalty * scale(cell) : scale(cell);
    });
    const Rect cell = grid_cell(c.grid, area_, 0);
    c.scale = scale(cell);
    c.cramped = is_cramped(cell);
    return c;
  }

  SheetLayout layout(const Choice& c) const {
    SheetLayout out;
    const Rect first = grid_cell(c.grid, area_, 0);
    out.hatch_size = std::min(1.0f, line_room(first) / (0.6f * normal_));
    out.longest_arrow = arrow_length(first);
    out.label_gap = line_room(first);
    const Framing fit = framing(first);
    // Where a time is wider than its cell it takes several; the others go without.
    const int cells = std::max(1, static_cast<int>(std::ceil((c.widest + 0.8f * text_) / first.width())));
    for (int i = 0; i < static_cast<int>(c.times.size()); ++i) {
      const Rect cell = grid_cell(c.grid, area_, i), below = room(cell);
      SheetLayout::Panel panel{cell, fit.fit(below), {}, {}};
      const int column = i % c.grid.columns;
      if (column % cells == 0 && (column == 0 || column + cells <= c.grid.columns)) {
        panel.time = c.times[static_cast<std::size_t>(i)];
        const float last = cell.x0 + static_cast<float>(cells) * cell.width() - 0.8f * text_ -
                           canvas_.text_width(TextSize::small, panel.time);
        // The time stands above what the camera shows, not above an empty part of the cell.
        panel.time_at = {
            std::max(cell.x0, std::min(panel.camera.pixel(bounds_[0], 0).x, std::min(last, below.x1))),
            fit.covered(panel.camera, below).y0 - time_line(cell) + 0.5f * text_};
      }
      out.panels.push_back(std::move(panel));
    }
    return out;
  }

 private:
  float time_line(const Rect& cell) const { return std::min(1.5f * text_, 0.6f * cell.height()); }
  // What is left below the time, and apart from the next row's times: each is to be read with its own shape.
  Rect room(const Rect& cell) const {
    const float gap = std::min(0.5f * text_, 0.08f * cell.height());
    return {cell.x0, cell.y0 + time_line(cell), cell.x1, cell.y1 - gap};
  }
  float shorter_side(const Rect& cell) const { return std::min(cell.width(), room(cell).height()); }
  float line_room(const Rect& cell) const { return std::min(0.6f * normal_, 0.15f * shorter_side(cell)); }
  float arrow_length(const Rect& cell) const { return std::min(2.1f * normal_, 0.6f * shorter_side(cell)); }

  Framing framing(const Rect& cell) const {
    const float margin = line_room(cell);
    // Several bodies in a cell stand nearer to each other than to the next cell's.
    const float side = label_room_ > 0 ? std::max(margin, 0.09f * cell.width()) : margin;
    Framing f(bounds_, {side, margin, side, margin + std::min(label_room_, 0.3f * room(cell).height())});
    TractionArrows::add_to(f, canvas_, arrows_, arrow_length(cell));
    return f;
  }

  const Canvas& canvas_;
  Rect area_;
  std::array<double, 4> bounds_;
  std::span<const TractionArrows::Arrow> arrows_;
  float label_room_;
  float text_, normal_;
};

}  // namespace

SheetLayout layout_sheet(const Canvas& canvas, const Rect& area, const std::array<double, 4>& bounds,
                         std::span<const double> times, std::span<const std::string_view> captions,
                         std::span<const TractionArrows::Arrow> arrows, float label_room) {
  const Sheet sheet(canvas, area, bounds, arrows, label_room);
  std::vector<std::string> whole, captioned, brief = short_times(times), brief_captioned = brief;
  bool has_captions = false;
  double longest = 0;
  for (const double t : times) longest = std::max(longest, std::isfinite(t) ? std::abs(t) : 0.0);
  for (std::size_t i = 0; i < times.size(); ++i) {
    whole.push_back(time_text(times[i], longest));
    captioned.push_back(whole.back());
    if (captions[i].empty()) continue;
    has_captions = true;
    captioned.back().append("   ").append(captions[i]);
    brief_captioned[i].append("   ").append(captions[i]);
  }
  const auto better = [&](std::vector<std::string> with_name, std::vector<std::string> without) {
    const Sheet::Choice a = sheet.choose(std::move(with_name)), b = sheet.choose(std::move(without));
    const bool short_is_better =
        (a.cramped && !b.cramped) || (a.cramped == b.cramped && b.scale > 1.1 * a.scale);
    return short_is_better ? b : a;
  };
  if (has_captions) {
    const Sheet::Choice choice = better(std::move(captioned), std::move(brief_captioned));
    if (!choice.cramped) return sheet.layout(choice);
  }
  SheetLayout layout = sheet.layout(better(std::move(whole), std::move(brief)));
  // Where not all have room, what of each has.
  constexpr std::size_t least = 6;  // characters, or it says nothing
  const float gap = 0.8f * canvas.text_size(TextSize::small);
  for (std::size_t i = 0; i < captions.size() && has_captions; ++i) {
    SheetLayout::Panel& panel = layout.panels[i];
    if (panel.time.empty() || captions[i].empty()) continue;
    const std::string full = panel.time + "   " + std::string(captions[i]);
    const std::string cut = canvas.fit(TextSize::small, full, panel.cell.x1 - panel.time_at.x - gap);
    if (cut.size() >= std::min(full.size(), panel.time.size() + 3 + least)) panel.time = cut;
  }
  return layout;
}

int sheet_room(int width, int height) {
  const double text = text_height(width, height);
  // Beside margins, heading and colour bar; a cell for a short time and a shape twice as high as it.
  const int columns = static_cast<int>((width - 8 * text) / (3.4 * text));
  const int rows = static_cast<int>((height - 5 * text) / (3.4 * text));
  return std::max(columns, 1) * std::max(rows, 1);
}

}  // namespace render
