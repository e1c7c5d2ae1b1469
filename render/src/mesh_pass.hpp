// The mesh on the graphics side: triangles filled by colour, their thin lines, the outline, the rest shape.
//
// Nodes live in one RGBA32F texture (x, y relative to the mesh origin, colour coordinate, finite or not),
// uploaded once a frame and only when it differs; everything that refers to nodes is uploaded once.
//
// Shapes   positions n x 2, scalar n or empty, triangles m x 3, boundary k x 2
// Errors   std::runtime_error: more nodes than the driver's largest texture holds
// Not here text, arrows, hatches (canvas.hpp, traction_arrows.hpp, hatches.hpp)
#pragma once

#include <array>
#include <span>
#include <vector>

#include "boundary_chains.hpp"
#include "camera.hpp"
#include "gl_object.hpp"
#include "gl_program.hpp"
#include "render/mesh_picture.hpp"

namespace render {

struct LineStyle {
  Color color;
  float width = 1;  // pixels
  float dash = 0;   // period in pixels, 0: solid
};

class MeshPass {
 public:
  MeshPass(const Gl& gl, const MeshLayout& layout, const BoundaryChains& boundary, int width, int height);

  // From the next set_nodes() on; the layout's until then.
  void set_bounds(const std::array<double, 4>& bounds);
  void set_range(const std::array<double, 2>& range) { range_ = range; }
  void set_colors(Color plain, Color wire) {
    plain_ = plain;
    wire_ = wire;
  }
  void set_nodes(std::span<const double> positions, std::span<const double> scalar);
  std::int64_t uploads() const { return uploads_; }  // by set_nodes
  void fill(const Camera& camera, float line_width) const;
  // In the style's colour; in the scalar's where the body is so slender that it would hide all of it.
  void outline(const Camera& camera, const LineStyle& style) const;
  void rest_outline(const Camera& camera, const LineStyle& style) const {
    lines(boundary_, camera, style, rest_, 0);
  }
  // Where materials meet.
  void interfaces(const Camera& camera, const LineStyle& style) const {
    lines(interfaces_, camera, style, nodes_, 0);
  }

 private:
  struct NodeTexture {
    explicit NodeTexture(const Gl& gl) : texture(gl) {}
    GlTexture texture;
    std::vector<float> data;  // as uploaded
    bool all_finite = true;
  };

  void make_texture(NodeTexture& nodes) const;
  // Whether anything had to be uploaded.
  bool upload(NodeTexture& nodes, std::span<const double> positions, std::span<const double> scalar);
  void upload_colors() const;
  void upload_triangles(std::span<const int> triangles, std::span<const double> rest);
  void bind_colors(const GlProgram& program, float colored) const;
  void set_fill(const GlProgram& program) const;
  // Edges to draw as lines.
  struct LineSet {
    explicit LineSet(const Gl& gl) : array(gl), buffer(gl) {}
    GlVertexArray array;
    GlBuffer buffer;
    GLsizei vertex_count = 0;
  };
  // Returns their length at rest [m].
  double upload_lines(const BoundaryChains& chains, std::span<const double> rest, LineSet& lines) const;
  void lines(const LineSet& set, const Camera& camera, const LineStyle& style, const NodeTexture& nodes,
             float colored) const;
  void place(const GlProgram& program, const Camera& camera, const NodeTexture& nodes) const;

  const Gl& gl_;
  int width_;
  int height_;
  std::size_t node_count_;
  std::vector<double> rest_positions_;
  std::array<double, 2> origin_{};
  double reach_ = 1;  // coordinates are clamped to this, far outside of any picture [m]
  std::array<double, 2> range_{};
  Color plain_, wire_;
  GlProgram mesh_program_;
  GlProgram dense_program_;
  GlProgram line_program_;
  GlVertexArray mesh_array_;
  GlVertexArray dense_array_;
  GlBuffer corners_;
  GlBuffer indices_;
  LineSet boundary_;
  LineSet interfaces_;
  GlTexture colors_;
  NodeTexture nodes_;
  NodeTexture rest_;
  std::vector<float> staging_;
  GLsizei corner_count_ = 0;
  double largest_height_ = 0;   // of all triangles at rest, each one's smallest [m]
  double area_ = 0;             // at rest [m^2]
  double boundary_length_ = 0;  // at rest [m]
  float colored_ = 0;
  std::int64_t uploads_ = 0;
};

}  // namespace render
