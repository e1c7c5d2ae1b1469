#include "render/mesh_picture.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>
#include <vector>

#include "body_labels.hpp"
#include "camera.hpp"
#include "canvas.hpp"
#include "color_bar.hpp"
#include "hatches.hpp"
#include "mesh_pass.hpp"
#include "render/context.hpp"
#include "sheet_layout.hpp"
#include "target.hpp"
#include "theme.hpp"
#include "ticks.hpp"
#include "traction_arrows.hpp"

namespace render {
namespace {

Context& current(Context& context) {
  context.make_current();
  return context;
}

// What of the layout is needed beyond the constructor: copies, for its spans end with the call.
struct Body {
  explicit Body(const MeshLayout& layout)
      : boundary(chain_boundary(layout.boundary)),
        title(layout.title),
        bar{layout.scalar_name, layout.scalar_unit, layout.range},
        bounds(usable_bounds(layout.bounds)),
        arrow_scale(layout.arrow_scale),
        labels(layout.labels) {}

  BoundaryChains boundary;
  std::string title;
  ColorBar bar;
  std::array<double, 4> bounds;
  double arrow_scale;
  BodyLabels labels;
};

}  // namespace

// A frame with its own memory, to tell whether the next one is another.
struct Shown {
  std::vector<double> positions, scalar;
  std::vector<int> held;
  std::vector<TractionArrow> arrows;

  bool looks_like(const MeshFrame& frame) const {
    return std::ranges::equal(positions, frame.positions) && std::ranges::equal(scalar, frame.scalar) &&
           std::ranges::equal(held, frame.held) && std::ranges::equal(arrows, frame.arrows);
  }
  void take(const MeshFrame& frame) {
    positions.assign(frame.positions.begin(), frame.positions.end());
    scalar.assign(frame.scalar.begin(), frame.scalar.end());
    held.assign(frame.held.begin(), frame.held.end());
    arrows.assign(frame.arrows.begin(), frame.arrows.end());
  }
};

struct MeshPicture::Impl {
  Impl(Context& c, const MeshLayout& layout)
      : context(current(c)),
        gl(c.gl()),
        body(layout),
        target(gl, c.width(), c.height()),
        canvas(gl, c.width(), c.height(),
               layout.title + layout.scalar_name + layout.scalar_unit + body.labels.characters()),
        pass(gl, layout, body.boundary, c.width(), c.height()),
        arrows(body.boundary.edges, layout.triangles, {layout.rest.begin(), layout.rest.end()}) {}

  // The picture's parts: the title line, the colour bar, and what is left for the body.
  struct Parts {
    Rect title, bar, body;
  };
  Parts parts() const {
    const auto w = static_cast<float>(canvas.width()), h = static_cast<float>(canvas.height());
    const float text = canvas.text_size(TextSize::normal), margin = 1.1f * text;
    Parts p;
    p.title = {margin, margin, w - margin, margin + canvas.text_size(TextSize::title)};
    const float top = p.title.y1 + 0.9f * text;
    float right = w - margin;
    if (!body.bar.name.empty()) {
      p.bar = {right - color_bar_width(canvas, body.bar), top, right, h - margin};
      // A tall bar beside a small picture of the body is no help: it keeps to the middle of a tall picture.
      const float tallest = 24 * text;
      if (p.bar.height() > tallest) {
        const float middle = (p.bar.y0 + p.bar.y1) / 2;
        p.bar.y0 = middle - tallest / 2;
        p.bar.y1 = middle + tallest / 2;
      }
      right = p.bar.x0 - 1.4f * text;
    }
    p.body = {margin, top, right, h - margin};
    return p;
  }

  // Space for hatches and lines, and for as much again; little of a small area.
  float line_room(const Rect& area) const {
    return std::min(0.6f * canvas.text_size(TextSize::normal), 0.08f * std::min(area.width(), area.height()));
  }
  float arrow_length(const Rect& area) const {
    return std::min(2.8f * canvas.text_size(TextSize::normal), 0.2f * std::min(area.width(), area.height()));
  }

  void begin() {
    context.make_current();
    target.bind();
    canvas.set_texts({});
    gl.Disable(GL_DEPTH_TEST);
    gl.Disable(GL_CULL_FACE);
    gl.Disable(GL_SCISSOR_TEST);
    gl.Disable(GL_BLEND);
    gl.ClearColor(theme::paper.r / 255.0f, theme::paper.g / 255.0f, theme::paper.b / 255.0f, 1.0f);
    gl.Clear(GL_COLOR_BUFFER_BIT);
  }

  void draw_body(const Camera& camera, const MeshFrame& frame, float hatch_size, float longest_arrow,
                 const Rect& value_area) {
    const float unit = canvas.unit();
    draw_hatches(canvas, camera, body.boundary, frame.positions, frame.held, hatch_size, mark);
    canvas.flush();
    pass.set_nodes(frame.positions, frame.scalar);
    pass.fill(camera, std::max(0.8f, 0.9f * unit));
    Color rest = theme::ink;
    rest.a = 130;
    pass.interfaces(camera, {theme::paper, theme::interface_rim_width(unit), 0});
    pass.interfaces(camera, {theme::ink, theme::interface_width(unit), 0});
    pass.rest_outline(camera, {rest, std::max(1.0f, 1.2f * unit), 9 * unit});
    pass.outline(camera, {theme::ink, theme::outline_width(unit), 0});
    arrows.draw(canvas, camera, frame, body.arrow_scale, longest_arrow, value_area);
  }

  // As much of the title as leaves `taken` pixels at its right.
  std::string title_beside(const Parts& p, float taken) const {
    return canvas.fit(TextSize::title, body.title, p.title.width() - taken);
  }

  // Of every panel; empty where some name has no place.
  std::vector<std::vector<Rect>> sheet_labels(const SheetLayout& layout,
                                              std::span<const MeshFrame> frames) const {
    std::vector<std::vector<Rect>> all;
    const float text = canvas.text_size(TextSize::small);
    for (std::size_t i = 0; i < frames.size() && !body.labels.empty(); ++i) {
      const SheetLayout::Panel& panel = layout.panels[i];
      Rect area = panel.cell;
      area.y0 = std::min(area.y1, panel.time_at.y + 0.8f * text);
      all.push_back(body.labels.boxes(canvas, panel.camera, frames[i].positions, TextSize::small,
                                      layout.label_gap, area));
      if (std::ranges::any_of(all.back(), [](const Rect& r) { return !(r.width() > 0); })) return {};
    }
    return all;
  }

  void draw_heading(const Parts& p, const std::string& title) {
    const float y = (p.title.y0 + p.title.y1) / 2;
    canvas.text({p.title.x0, y}, Align::left, TextSize::title, theme::ink, title);
    if (!body.bar.name.empty()) draw_color_bar(canvas, body.bar, p.bar);
  }

  // All of a frame but its time.
  void draw_still(const MeshFrame& frame, const Parts& p, const std::string& title) {
    begin();
    // The arrows of other frames are not known: room for them on every side.
    const float arrow = arrow_length(p.body);
    const float margin = line_room(p.body) + (body.arrow_scale > 0 ? arrow : 0.0f);
    const float below = margin + body.labels.room(canvas, TextSize::normal);
    const Framing framing(body.bounds, {margin, margin, margin, below});
    const Camera camera = framing.fit(p.body);
    draw_body(camera, frame, 1, arrow, p.body);
    body.labels.draw(
        canvas,
        body.labels.boxes(canvas, camera, frame.positions, TextSize::normal, line_room(p.body), p.body),
        TextSize::normal);
    draw_heading(p, title);
    canvas.flush();
    still_texts = canvas.texts();
  }

  Context& context;
  const Gl& gl;
  Body body;
  Target target;
  Canvas canvas;
  MeshPass pass;
  TractionArrows arrows;
  std::vector<char> mark;
  std::optional<Shown> last;    // drawn by draw()
  std::string last_title;       // as much of it as its time left room for
  std::optional<Target> still;  // all of it but its time, from its first repetition on
  bool still_current = false;
  std::vector<TextBox> still_texts;
  PictureCounters counters;
};

MeshPicture::MeshPicture(Context& context, const MeshLayout& layout)
    : impl_(std::make_unique<Impl>(context, layout)) {}

MeshPicture::~MeshPicture() {
  if (impl_) impl_->context.make_current();
}

MeshPicture::MeshPicture(MeshPicture&&) noexcept = default;

void MeshPicture::draw(const MeshFrame& frame, Image& out) {
  Impl& m = *impl_;
  m.context.make_current();
  const Impl::Parts p = m.parts();
  const std::string time = time_text(frame.time);
  std::string title = m.title_beside(p, m.canvas.text_width(TextSize::normal, time) + p.title.y0);
  const bool repeated = m.last && m.last_title == title && m.last->looks_like(frame);
  if (repeated && m.still_current) {
    m.target.copy(*m.still);
    m.target.bind();
    m.canvas.set_texts(m.still_texts);
    ++m.counters.frames_repeated;
  } else {
    m.draw_still(frame, p, title);
    ++m.counters.frames_drawn;
    // Kept when it has come twice: frames that all differ pay nothing.
    if (repeated) {
      if (!m.still) m.still.emplace(m.gl, m.canvas.width(), m.canvas.height());
      m.still->copy(m.target);
      m.target.bind();
    } else {
      if (!m.last) m.last.emplace();
      m.last->take(frame);
      m.last_title = std::move(title);
    }
    m.still_current = repeated;
  }
  m.canvas.text({p.title.x1, (p.title.y0 + p.title.y1) / 2}, Align::right, TextSize::normal, theme::ink,
                time);
  m.canvas.flush();
  m.target.read(out);
}

Image MeshPicture::sheet(std::span<const MeshFrame> frames) {
  Impl& m = *impl_;
  m.begin();
  const Impl::Parts p = m.parts();
  std::vector<double> times;
  std::vector<TractionArrows::Arrow> arrows;
  for (const MeshFrame& frame : frames) {
    times.push_back(frame.time);
    const std::vector<TractionArrows::Arrow> more = m.arrows.arrows(frame, m.body.arrow_scale);
    arrows.insert(arrows.end(), more.begin(), more.end());
  }
  const SheetLayout layout = layout_sheet(m.canvas, p.body, m.body.bounds, times, arrows,
                                          m.body.labels.room(m.canvas, TextSize::small));
  const std::vector<std::vector<Rect>> labels = m.sheet_labels(layout, frames);
  for (std::size_t i = 0; i < frames.size(); ++i) {
    const SheetLayout::Panel& panel = layout.panels[i];
    m.draw_body(panel.camera, frames[i], layout.hatch_size, layout.longest_arrow, {});
    if (!labels.empty()) m.body.labels.draw(m.canvas, labels[i], TextSize::small);
    m.canvas.text(panel.time_at, Align::left, TextSize::small, theme::ink, panel.time);
  }
  m.draw_heading(p, m.title_beside(p, 0.0f));
  m.canvas.flush();
  Image out;
  m.target.read(out);
  return out;
}

const std::vector<TextBox>& MeshPicture::texts() const {
  return impl_->canvas.texts();
}

PictureCounters MeshPicture::counters() const {
  PictureCounters counters = impl_->counters;
  counters.mesh_uploads = impl_->pass.uploads();
  return counters;
}

}  // namespace render
