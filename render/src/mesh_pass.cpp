#include "mesh_pass.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cassert>
#include <cmath>
#include <cstddef>
#include <stdexcept>

#include "colormap.hpp"
#include "theme.hpp"

namespace render {
namespace {

constexpr std::size_t row = 1024;  // nodes in a row of the texture; the shaders know it too

std::size_t row_count(std::size_t nodes) {
  return std::max<std::size_t>((nodes + row - 1) / row, 1);
}

void sample_nearest(const Gl& gl, GLint filter) {
  gl.TexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, filter);
  gl.TexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, filter);
  gl.TexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_S, GL_CLAMP_TO_EDGE);
  gl.TexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_T, GL_CLAMP_TO_EDGE);
}

void uniform_color(const Gl& gl, GLint where, Color c) {
  gl.Uniform4f(where, c.r / 255.0f, c.g / 255.0f, c.b / 255.0f, c.a / 255.0f);
}

struct Shape {
  double area = 0, smallest_height = 0;
};

Shape shape_of(std::span<const double> points, std::span<const int> triangle) {
  const auto at = [&](std::size_t k) {
    const auto i = 2 * static_cast<std::size_t>(triangle[k]);
    return std::array<double, 2>{points[i], points[i + 1]};
  };
  const auto [ax, ay] = at(0);
  const auto [bx, by] = at(1);
  const auto [cx, cy] = at(2);
  const double longest =
      std::max({std::hypot(bx - ax, by - ay), std::hypot(cx - bx, cy - by), std::hypot(ax - cx, ay - cy)});
  const double twice = std::abs((bx - ax) * (cy - ay) - (by - ay) * (cx - ax));
  return {twice / 2, longest > 0 ? twice / longest : 0.0};
}

// Where a value lies in the range, 0..1. A range without extent, or without numbers, gives the low colour.
float colour_coordinate(double value, const std::array<double, 2>& range) {
  const double t = (value - range[0]) / (range[1] - range[0]);
  if (!(range[1] > range[0]) || std::isnan(t)) return 0.0f;
  return static_cast<float>(std::clamp(t, 0.0, 1.0));
}

}  // namespace

MeshPass::MeshPass(const Gl& gl, const MeshLayout& layout, const BoundaryChains& boundary, int width,
                   int height)
    : gl_(gl),
      width_(width),
      height_(height),
      node_count_(layout.rest.size() / 2),
      rest_positions_(layout.rest.begin(), layout.rest.end()),
      range_(layout.range),
      plain_(theme::light.plain_fill),
      wire_(theme::light.wire),
      mesh_program_(gl, "mesh", {"corner"}),
      dense_program_(gl, "dense", {}),
      line_program_(gl, "line", {"ends", "along"}),
      mesh_array_(gl),
      dense_array_(gl),
      corners_(gl),
      indices_(gl),
      boundary_(gl),
      interfaces_(gl),
      colors_(gl),
      nodes_(gl),
      rest_(gl) {
  GLint limit = 0;
  gl.GetIntegerv(GL_MAX_TEXTURE_SIZE, &limit);
  if (row_count(node_count_) > static_cast<std::size_t>(limit)) {
    throw std::runtime_error(fmt::format("{} nodes are more than this driver's textures hold ({})",
                                         node_count_, row * static_cast<std::size_t>(limit)));
  }
  colored_ = layout.scalar_name.empty() ? 0.0f : 1.0f;
  make_texture(nodes_);
  make_texture(rest_);
  set_bounds(usable_bounds(layout.bounds));
  upload_colors();
  upload_triangles(layout.triangles, layout.rest);
  boundary_length_ = upload_lines(boundary, layout.rest, boundary_);
  upload_lines(chain_boundary(layout.interfaces), layout.rest, interfaces_);
}

void MeshPass::make_texture(NodeTexture& nodes) const {
  gl_.ActiveTexture(GL_TEXTURE0);
  gl_.BindTexture(GL_TEXTURE_2D, nodes.texture.id());
  sample_nearest(gl_, GL_NEAREST);
  gl_.TexImage2D(GL_TEXTURE_2D, 0, GL_RGBA32F, row, static_cast<GLsizei>(row_count(node_count_)), 0, GL_RGBA,
                 GL_FLOAT, nullptr);
}

// Coordinates of single precision are measured from the middle of what is seen: fine there, and the same
// however one came to see it.
void MeshPass::set_bounds(const std::array<double, 4>& b) {
  origin_ = {(b[0] + b[2]) / 2, (b[1] + b[3]) / 2};
  reach_ = 1e3 * std::max(b[2] - b[0], b[3] - b[1]);
  upload(rest_, rest_positions_, {});
}

void MeshPass::set_nodes(std::span<const double> positions, std::span<const double> scalar) {
  if (upload(nodes_, positions, scalar)) ++uploads_;
}

bool MeshPass::upload(NodeTexture& nodes, std::span<const double> positions, std::span<const double> scalar) {
  assert(positions.size() == 2 * node_count_);
  assert(scalar.empty() || scalar.size() == node_count_);
  bool all_finite = true;
  staging_.resize(row_count(node_count_) * row * 4);
  for (std::size_t i = 0; i < node_count_; ++i) {
    const double x = positions[2 * i] - origin_[0], y = positions[2 * i + 1] - origin_[1];
    const bool finite = std::isfinite(x) && std::isfinite(y);
    float* to = staging_.data() + 4 * i;
    to[0] = finite ? static_cast<float>(std::clamp(x, -reach_, reach_)) : 0.0f;
    to[1] = finite ? static_cast<float>(std::clamp(y, -reach_, reach_)) : 0.0f;
    to[2] = scalar.empty() ? 0.0f : colour_coordinate(scalar[i], range_);
    to[3] = finite ? 1.0f : 0.0f;
    all_finite = all_finite && finite;
  }
  if (nodes.data == staging_) return false;
  std::swap(nodes.data, staging_);
  nodes.all_finite = all_finite;
  gl_.ActiveTexture(GL_TEXTURE0);
  gl_.BindTexture(GL_TEXTURE_2D, nodes.texture.id());
  gl_.PixelStorei(GL_UNPACK_ALIGNMENT, 4);
  gl_.TexSubImage2D(GL_TEXTURE_2D, 0, 0, 0, row, static_cast<GLsizei>(row_count(node_count_)), GL_RGBA,
                    GL_FLOAT, nodes.data.data());
  return true;
}

void MeshPass::upload_colors() const {
  const std::array<Rgb, 256> map = make_colormap();
  std::array<std::uint8_t, 1024> pixels{};
  for (std::size_t i = 0; i < map.size(); ++i) {
    for (std::size_t k = 0; k < 3; ++k) pixels[4 * i + k] = map[i][k];
    pixels[4 * i + 3] = 255;
  }
  gl_.ActiveTexture(GL_TEXTURE1);
  gl_.BindTexture(GL_TEXTURE_2D, colors_.id());
  sample_nearest(gl_, GL_LINEAR);
  gl_.TexImage2D(GL_TEXTURE_2D, 0, GL_RGBA8, 256, 1, 0, GL_RGBA, GL_UNSIGNED_BYTE, pixels.data());
}

void MeshPass::upload_triangles(std::span<const int> triangles, std::span<const double> rest) {
  std::vector<GLint> corners;
  corners.reserve(triangles.size() * 3);
  for (std::size_t t = 0; t + 2 < triangles.size(); t += 3) {
    const Shape shape = shape_of(rest, triangles.subspan(t, 3));
    largest_height_ = std::max(largest_height_, shape.smallest_height);
    if (std::isfinite(shape.area)) area_ += shape.area;
    for (std::size_t k = 0; k < 3; ++k) {
      for (std::size_t s = 0; s < 3; ++s) {
        const int node = triangles[t + (k + s) % 3];
        assert(node >= 0 && static_cast<std::size_t>(node) < node_count_);
        corners.push_back(node);
      }
    }
  }
  corner_count_ = static_cast<GLsizei>(corners.size() / 3);
  gl_.BindVertexArray(mesh_array_.id());
  gl_.BindBuffer(GL_ARRAY_BUFFER, corners_.id());
  gl_.BufferData(GL_ARRAY_BUFFER, static_cast<GLsizeiptr>(corners.size() * sizeof(GLint)), corners.data(),
                 GL_STATIC_DRAW);
  gl_.EnableVertexAttribArray(0);
  gl_.VertexAttribIPointer(0, 3, GL_INT, 0, nullptr);
  gl_.BindVertexArray(dense_array_.id());
  gl_.BindBuffer(GL_ELEMENT_ARRAY_BUFFER, indices_.id());
  gl_.BufferData(GL_ELEMENT_ARRAY_BUFFER, static_cast<GLsizeiptr>(triangles.size_bytes()), triangles.data(),
                 GL_STATIC_DRAW);
}

double MeshPass::upload_lines(const BoundaryChains& chains, std::span<const double> rest,
                              LineSet& lines) const {
  double length = 0;
  struct Vertex {
    std::array<GLint, 3> ends;
    GLfloat along;
  };
  std::vector<Vertex> vertices;
  vertices.reserve(chains.edges.size() * 3);
  for (std::size_t chain = 0; chain < chains.count(); ++chain) {
    const std::size_t begin = chains.offsets[chain], end = chains.offsets[chain + 1];
    double along = 0;
    for (std::size_t e = begin; e < end; ++e) {
      const auto a = static_cast<std::size_t>(chains.edges[2 * e]);
      const auto b = static_cast<std::size_t>(chains.edges[2 * e + 1]);
      assert(a < node_count_ && b < node_count_);
      // The end of the edge that follows; -1 at the end of an open chain.
      const GLint next = e + 1 < end            ? chains.edges[2 * e + 3]
                         : chains.closed(chain) ? chains.edges[2 * begin + 1]
                                                : -1;
      for (int k = 0; k < 6; ++k)
        vertices.push_back(
            {{static_cast<GLint>(a), static_cast<GLint>(b), next}, static_cast<GLfloat>(along)});
      const double size = std::hypot(rest[2 * b] - rest[2 * a], rest[2 * b + 1] - rest[2 * a + 1]);
      if (std::isfinite(size)) along += size, length += size;
    }
  }
  lines.vertex_count = static_cast<GLsizei>(vertices.size());
  gl_.BindVertexArray(lines.array.id());
  gl_.BindBuffer(GL_ARRAY_BUFFER, lines.buffer.id());
  gl_.BufferData(GL_ARRAY_BUFFER, static_cast<GLsizeiptr>(vertices.size() * sizeof(Vertex)), vertices.data(),
                 GL_STATIC_DRAW);
  gl_.EnableVertexAttribArray(0);
  gl_.VertexAttribIPointer(0, 3, GL_INT, sizeof(Vertex), nullptr);
  gl_.EnableVertexAttribArray(1);
  gl_.VertexAttribPointer(1, 1, GL_FLOAT, GL_FALSE, sizeof(Vertex),
                          reinterpret_cast<const void*>(offsetof(Vertex, along)));
  return length;
}

void MeshPass::place(const GlProgram& program, const Camera& camera, const NodeTexture& nodes) const {
  program.use();
  gl_.ActiveTexture(GL_TEXTURE0);
  gl_.BindTexture(GL_TEXTURE_2D, nodes.texture.id());
  gl_.Uniform1i(program.uniform("nodes"), 0);
  const Point at = camera.pixel(origin_[0], origin_[1]);
  const auto scale = static_cast<float>(camera.scale);
  gl_.Uniform4f(program.uniform("view"), scale, -scale, at.x, at.y);
  gl_.Uniform4f(program.uniform("to_clip"), 2.0f / static_cast<float>(width_),
                2.0f / static_cast<float>(height_), -1.0f, -1.0f);
}

void MeshPass::bind_colors(const GlProgram& program, float colored) const {
  gl_.ActiveTexture(GL_TEXTURE1);
  gl_.BindTexture(GL_TEXTURE_2D, colors_.id());
  gl_.Uniform1i(program.uniform("colors"), 1);
  gl_.Uniform1f(program.uniform("colored"), colored);
}

void MeshPass::set_fill(const GlProgram& program) const {
  bind_colors(program, colored_);
  uniform_color(gl_, program.uniform("plain"), plain_);
}

void MeshPass::fill(const Camera& camera, float line_width) const {
  if (corner_count_ == 0) return;
  // Lines begin to show at 2.5 times their width (mesh.vert); triangles grow a little by deformation.
  const double limit = 1.8 * std::max(line_width, 1.0f);
  const bool dense = largest_height_ * camera.scale < limit && nodes_.all_finite;
  const GlProgram& program = dense ? dense_program_ : mesh_program_;
  place(program, camera, nodes_);
  set_fill(program);
  if (dense) {
    gl_.BindVertexArray(dense_array_.id());
    gl_.DrawElements(GL_TRIANGLES, corner_count_, GL_UNSIGNED_INT, nullptr);
    return;
  }
  gl_.Uniform1f(program.uniform("wire_half"), line_width / 2);
  uniform_color(gl_, program.uniform("wire"), wire_);
  gl_.BindVertexArray(mesh_array_.id());
  gl_.DrawArrays(GL_TRIANGLES, 0, corner_count_);
}

void MeshPass::outline(const Camera& camera, const LineStyle& style) const {
  // A strip of width d and length l has the area d l within a boundary of 2 l.
  const double width = boundary_length_ > 0 ? 2 * area_ / boundary_length_ * camera.scale : 0.0;
  lines(boundary_, camera, style, nodes_, width < 1.5 * style.width ? colored_ : 0.0f);
}

void MeshPass::lines(const LineSet& set, const Camera& camera, const LineStyle& style,
                     const NodeTexture& nodes, float colored) const {
  if (set.vertex_count == 0) return;
  place(line_program_, camera, nodes);
  gl_.Uniform1f(line_program_.uniform("half_width"), style.width / 2);
  gl_.Uniform1f(line_program_.uniform("dash"), style.dash);
  uniform_color(gl_, line_program_.uniform("ink"), style.color);
  bind_colors(line_program_, colored);
  gl_.Enable(GL_BLEND);
  gl_.BlendEquation(GL_FUNC_ADD);
  gl_.BlendFuncSeparate(GL_SRC_ALPHA, GL_ONE_MINUS_SRC_ALPHA, GL_ONE, GL_ONE_MINUS_SRC_ALPHA);
  gl_.BindVertexArray(set.array.id());
  gl_.DrawArrays(GL_TRIANGLES, 0, set.vertex_count);
  gl_.Disable(GL_BLEND);
}

}  // namespace render
