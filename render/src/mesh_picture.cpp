#include "render/mesh_picture.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <string>
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
        bar{layout.scalar_name, layout.scalar_unit, layout.range, layout.bar_room},
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
  Impl(Context& c, const MeshLayout& layout, int width, int height)
      : context(current(c)),
        gl(c.gl()),
        body(layout),
        view{.range = layout.range, .bounds = body.bounds, .arrow_scale = layout.arrow_scale},
        target(gl, width, height),
        canvas(gl, width, height,
               layout.title + layout.letters + layout.scalar_name + layout.scalar_unit +
                   body.labels.characters()),
        pass(gl, layout, body.boundary, width, height),
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
    const Color paper = canvas.palette().paper;
    gl.ClearColor(paper.r / 255.0f, paper.g / 255.0f, paper.b / 255.0f, 1.0f);
    gl.Clear(GL_COLOR_BUFFER_BIT);
  }

  void draw_body(const Camera& camera, const MeshFrame& frame, float hatch_size, float longest_arrow,
                 const Rect& value_area) {
    const float unit = canvas.unit();
    draw_hatches(canvas, camera, body.boundary, frame.positions, frame.held, hatch_size, mark);
    canvas.flush();
    pass.set_nodes(frame.positions, frame.scalar);
    pass.fill(camera, std::max(0.8f, 0.9f * unit));
    Color rest = canvas.palette().ink;
    rest.a = 130;
    pass.interfaces(camera, {canvas.palette().paper, theme::interface_rim_width(unit), 0});
    pass.interfaces(camera, {canvas.palette().ink, theme::interface_width(unit), 0});
    if (view.rest_shape == Show::yes)
      pass.rest_outline(camera, {rest, std::max(1.0f, 1.2f * unit), 9 * unit});
    pass.outline(camera, {canvas.palette().ink, theme::outline_width(unit), 0});
    if (view.node_numbers == Show::yes) draw_node_numbers(camera, frame);
    arrows.draw(canvas, camera, frame, body.arrow_scale, longest_arrow, value_area);
  }

  // Those that have room beside the ones before them: their boxes, which are of one height and found by the
  // square that their corner is in, do not touch.
  void draw_node_numbers(const Camera& camera, const MeshFrame& frame) {
    const float text = canvas.text_size(TextSize::small), dot = 2.5f * canvas.unit();
    const std::size_t nodes = frame.positions.size() / 2;
    const float widest = canvas.text_width(TextSize::small, std::to_string(nodes)) + 0.3f * text + dot;
    const float square = std::max(widest, 1.2f * text + dot);
    const auto columns = static_cast<std::ptrdiff_t>(static_cast<float>(canvas.width()) / square) + 1;
    const auto rows = static_cast<std::ptrdiff_t>(static_cast<float>(canvas.height()) / square) + 1;
    Color plate = canvas.palette().paper;
    plate.a = 205;
    std::vector<std::vector<Rect>> taken(static_cast<std::size_t>(columns * rows));
    const auto is_free = [&](const Rect& box, std::ptrdiff_t column, std::ptrdiff_t row) {
      for (std::ptrdiff_t r = std::max<std::ptrdiff_t>(row - 1, 0); r < std::min(row + 2, rows); ++r)
        for (std::ptrdiff_t c = std::max<std::ptrdiff_t>(column - 1, 0); c < std::min(column + 2, columns);
             ++c)
          for (const Rect& other : taken[static_cast<std::size_t>(r * columns + c)])
            if (box.x0 < other.x1 && other.x0 < box.x1 && box.y0 < other.y1 && other.y0 < box.y1)
              return false;
      return true;
    };
    for (std::size_t i = 0; i < nodes; ++i) {
      const Point p = camera.pixel(frame.positions[2 * i], frame.positions[2 * i + 1]);
      if (!(p.x >= 0 && p.y >= 0 && p.x < static_cast<float>(canvas.width()) &&
            p.y < static_cast<float>(canvas.height())))
        continue;
      const std::string number = std::to_string(i);
      const Rect box{p.x - dot, p.y - 1.2f * text,
                     p.x + 0.3f * text + canvas.text_width(TextSize::small, number), p.y + dot};
      const auto column = static_cast<std::ptrdiff_t>(p.x / square),
                 row = static_cast<std::ptrdiff_t>(p.y / square);
      if (!is_free(box, column, row)) continue;
      taken[static_cast<std::size_t>(row * columns + column)].push_back(box);
      // To be read on any colour.
      canvas.rect({p.x + 0.2f * text, box.y0, box.x1, p.y - 0.05f * text}, plate, 0.2f * text);
      canvas.disk(p, dot, canvas.palette().ink);
      canvas.text({p.x + 0.3f * text, p.y - 0.6f * text}, Align::left, TextSize::small, canvas.palette().ink,
                  number);
    }
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
    canvas.text({p.title.x0, y}, Align::left, TextSize::title, canvas.palette().ink, title);
    if (!body.bar.name.empty()) draw_color_bar(canvas, body.bar, p.bar);
  }

  // For the traction's value between arrows and names.
  float value_room() const {
    return body.arrow_scale > 0 && !body.labels.empty() ? 1.1f * canvas.text_size(TextSize::normal) : 0.0f;
  }

  // The arrows of other frames are not known: room for them on every side.
  Camera camera(const Parts& p) const {
    const float margin = line_room(p.body) + (body.arrow_scale > 0 ? arrow_length(p.body) : 0.0f);
    const float below = margin + body.labels.room(canvas, TextSize::normal) + value_room();
    return Framing(body.bounds, {margin, margin, margin, below}).fit(p.body);
  }

  // All of a frame but its time.
  void draw_still(const MeshFrame& frame, const Parts& p, const std::string& title) {
    begin();
    const Camera seen = camera(p);
    draw_body(seen, frame, 1, arrow_length(p.body), p.body);
    // Beyond the arrows, in every frame of a sequence that has some.
    const float gap = line_room(p.body) + (body.arrow_scale > 0 ? arrow_length(p.body) : 0.0f) + value_room();
    body.labels.draw(canvas, body.labels.boxes(canvas, seen, frame.positions, TextSize::normal, gap, p.body),
                     TextSize::normal);
    draw_heading(p, title);
    canvas.flush();
    still_texts = canvas.texts();
  }

  Context& context;
  const Gl& gl;
  Body body;
  MeshView view;
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
    : MeshPicture(context, layout, context.width(), context.height()) {}
MeshPicture::MeshPicture(Context& context, const MeshLayout& layout, int width, int height)
    : impl_(std::make_unique<Impl>(context, layout, width, height)) {}

MeshPicture::~MeshPicture() {
  if (impl_) impl_->context.make_current();
}

MeshPicture::MeshPicture(MeshPicture&&) noexcept = default;

void MeshPicture::draw(const MeshFrame& frame, Image& out) {
  draw(frame);
  impl_->target.read(out);
}

void MeshPicture::read(Image& out) const {
  impl_->context.make_current();
  impl_->target.read(out);
}

void MeshPicture::set_view(const MeshView& view) {
  Impl& m = *impl_;
  if (m.view == view) return;
  m.context.make_current();
  if (view.bounds != m.view.bounds) m.pass.set_bounds(usable_bounds(view.bounds));
  m.view = view;
  m.body.bounds = usable_bounds(view.bounds);
  m.body.arrow_scale = view.arrow_scale;
  m.body.bar.range = view.range;
  const Palette& palette = view.shade == Shade::dark ? theme::dark : theme::light;
  m.canvas.set_palette(palette);
  m.pass.set_range(view.range);
  Color wire = palette.wire;
  if (view.mesh_lines == Show::no) wire.a = 0;
  m.pass.set_colors(palette.plain_fill, wire);
  m.last.reset();
  m.still_current = false;
}

const MeshView& MeshPicture::view() const {
  return impl_->view;
}

PlaneInPicture MeshPicture::plane() const {
  const Camera c = impl_->camera(impl_->parts());
  return {c.pixel_x - c.scale * c.x0, c.pixel_y + c.scale * c.y0, c.scale};
}

PictureArea MeshPicture::body_area() const {
  const Rect body = impl_->parts().body;
  return {body.x0, body.y0, body.x1, body.y1};
}

unsigned MeshPicture::framebuffer() const {
  return impl_->target.framebuffer();
}
int MeshPicture::width() const {
  return impl_->canvas.width();
}
int MeshPicture::height() const {
  return impl_->canvas.height();
}

void MeshPicture::draw(const MeshFrame& frame) {
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
  m.canvas.text({p.title.x1, (p.title.y0 + p.title.y1) / 2}, Align::right, TextSize::normal,
                m.canvas.palette().ink, time);
  m.canvas.flush();
}

Image MeshPicture::sheet(std::span<const MeshFrame> frames) {
  Impl& m = *impl_;
  m.begin();
  const Impl::Parts p = m.parts();
  std::vector<double> times;
  std::vector<std::string_view> captions;
  std::vector<TractionArrows::Arrow> arrows;
  for (const MeshFrame& frame : frames) {
    times.push_back(frame.time);
    captions.push_back(frame.caption);
    const std::vector<TractionArrows::Arrow> more = m.arrows.arrows(frame, m.body.arrow_scale);
    arrows.insert(arrows.end(), more.begin(), more.end());
  }
  const SheetLayout layout = layout_sheet(m.canvas, p.body, m.body.bounds, times, captions, arrows,
                                          m.body.labels.room(m.canvas, TextSize::small));
  const std::vector<std::vector<Rect>> labels = m.sheet_labels(layout, frames);
  for (std::size_t i = 0; i < frames.size(); ++i) {
    const SheetLayout::Panel& panel = layout.panels[i];
    m.draw_body(panel.camera, frames[i], layout.hatch_size, layout.longest_arrow, {});
    if (!labels.empty()) m.body.labels.draw(m.canvas, labels[i], TextSize::small);
    m.canvas.text(panel.time_at, Align::left, TextSize::small, m.canvas.palette().ink, panel.time);
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
