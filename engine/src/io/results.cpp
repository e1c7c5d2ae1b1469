#include "rheo/io/results.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cassert>
#include <cstdint>
#include <cstring>

#include "rheo/deformation.hpp"
#include "rheo/io/atomic_file.hpp"

namespace rheo {
namespace {

constexpr std::size_t block_bytes = std::size_t{1} << 20;  // text gathered before it is written

[[maybe_unused]] bool fits(const Mesh& mesh, const StateView& state) {
  const std::size_t size = 2 * mesh.points.size();
  return state.u.size() == size && state.v.size() == size && state.w_lambda.size() == size &&
         state.w_mu.size() == size;
}

std::string base64(std::span<const unsigned char> bytes) {
  static constexpr std::string_view letters =
      "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string text;
  text.reserve((bytes.size() + 2) / 3 * 4);
  for (std::size_t i = 0; i < bytes.size(); i += 3) {
    const auto byte = [&](std::size_t k) { return k < bytes.size() ? std::uint32_t{bytes[k]} : 0u; };
    const std::uint32_t group = byte(i) << 16 | byte(i + 1) << 8 | byte(i + 2);
    text += letters[group >> 18];
    text += letters[group >> 12 & 63];
    text += i + 1 < bytes.size() ? letters[group >> 6 & 63] : '=';
    text += i + 2 < bytes.size() ? letters[group & 63] : '=';
  }
  return text;
}

template <typename T>
constexpr const char* vtk_type() {
  if constexpr (std::is_same_v<T, double>) return "Float64";
  if constexpr (std::is_same_v<T, std::int64_t>) return "Int64";
  return "UInt8";
}

// One <DataArray>: its length in bytes as a 64-bit number, then the values, in base64.
template <typename T>
void write_array(AtomicFile& file, const char* name, int components, const std::vector<T>& values,
                 const char* attributes = "") {
  const std::uint64_t length = values.size() * sizeof(T);
  std::vector<unsigned char> bytes(sizeof length + length);
  std::memcpy(bytes.data(), &length, sizeof length);
  if (length > 0) std::memcpy(bytes.data() + sizeof length, values.data(), length);
  file.write(fmt::format(
      "        <DataArray type=\"{}\" Name=\"{}\" NumberOfComponents=\"{}\"{} format=\"binary\">\n",
      vtk_type<T>(), name, components, attributes));
  file.write(base64(bytes));
  file.write("\n        </DataArray>\n");
}

// n x 2 to n x 3 with z = 0, as ParaView wants its vectors.
std::vector<double> in_space(std::span<const double> plane) {
  std::vector<double> space(plane.size() / 2 * 3, 0.0);
  for (std::size_t i = 0; i < plane.size() / 2; ++i) {
    space[3 * i] = plane[2 * i];
    space[3 * i + 1] = plane[2 * i + 1];
  }
  return space;
}

std::string xml_text(std::string_view text) {
  std::string result;
  for (const char c : text) {
    switch (c) {
      case '&':
        result += "&amp;";
        break;
      case '<':
        result += "&lt;";
        break;
      case '>':
        result += "&gt;";
        break;
      case '"':
        result += "&quot;";
        break;
      default:
        result += c;
    }
  }
  return result;
}

void write_head(AtomicFile& file, const char* type) {
  constexpr const char* order = std::endian::native == std::endian::little ? "LittleEndian" : "BigEndian";
  file.write(
      fmt::format("<?xml version=\"1.0\"?>\n<VTKFile type=\"{}\" version=\"1.0\" byte_order=\"{}\" "
                  "header_type=\"UInt64\">\n",
                  type, order));
}

}  // namespace

void write_state_csv(const std::filesystem::path& path, const Mesh& mesh, const StateView& state,
                     const PartsView& parts) {
  assert(fits(mesh, state));
  AtomicFile file(path);
  std::string text = "node,x,y,ux,uy,vx,vy,w_lambda_x,w_lambda_y,w_mu_x,w_mu_y";
  text += parts.bodies.empty() ? "\n" : ",body\n";
  std::size_t body = 0;
  for (std::size_t i = 0; i < mesh.points.size(); ++i) {
    text += fmt::format("{},{:.17g},{:.17g}", i, mesh.points[i].x, mesh.points[i].y);
    for (const auto& block : {state.u, state.v, state.w_lambda, state.w_mu}) {
      text += fmt::format(",{:.17g},{:.17g}", block[2 * i], block[2 * i + 1]);
    }
    if (!parts.bodies.empty()) {
      while (body + 1 < parts.bodies.size() &&
             i >= static_cast<std::size_t>(parts.bodies[body + 1].first_node))
        ++body;
      text += fmt::format(",{}", body + 1);
    }
    text += '\n';
    if (text.size() > block_bytes) {
      file.write(text);
      text.clear();
    }
  }
  file.write(text);
  file.commit();
}

void write_vtu(const std::filesystem::path& path, const Mesh& mesh, const StateView& state,
               const PartsView& parts) {
  assert(fits(mesh, state));
  constexpr unsigned char vtk_triangle = 5;
  AtomicFile file(path);
  write_head(file, "UnstructuredGrid");
  file.write(fmt::format("  <UnstructuredGrid>\n    <Piece NumberOfPoints=\"{}\" NumberOfCells=\"{}\">\n",
                         mesh.points.size(), mesh.triangles.size()));

  std::vector<double> plane;
  plane.reserve(2 * mesh.points.size());
  for (const Vec2 p : mesh.points) plane.insert(plane.end(), {p.x, p.y});
  file.write("      <Points>\n");
  write_array(file, "Points", 3, in_space(plane));
  file.write("      </Points>\n      <Cells>\n");
  std::vector<std::int64_t> corners, ends;
  corners.reserve(3 * mesh.triangles.size());
  ends.reserve(mesh.triangles.size());
  for (const Triangle& t : mesh.triangles) {
    corners.insert(corners.end(), t.begin(), t.end());
    ends.push_back(static_cast<std::int64_t>(corners.size()));
  }
  write_array(file, "connectivity", 1, corners);
  write_array(file, "offsets", 1, ends);
  write_array(file, "types", 1, std::vector<std::uint8_t>(mesh.triangles.size(), vtk_triangle));
  file.write("      </Cells>\n      <PointData Vectors=\"u\">\n");
  write_array(file, "u", 3, in_space(state.u));
  write_array(file, "v", 3, in_space(state.v));
  write_array(file, "w_lambda", 3, in_space(state.w_lambda));
  write_array(file, "w_mu", 3, in_space(state.w_mu));
  file.write("      </PointData>\n      <CellData>\n");
  constexpr const char* names = " ComponentName0=\"xx\" ComponentName1=\"yy\" ComponentName2=\"xy\"";
  std::vector<double> tensor(3 * mesh.triangles.size());
  strain(mesh, state.u, tensor);
  write_array(file, "strain", 3, tensor, names);
  const bool apart = !state.pull_lambda.empty();
  if (state.stress.empty())
    stress(mesh, apart ? state.pull_lambda : state.w_lambda, apart ? state.pull_mu : state.w_mu, tensor);
  else
    tensor.assign(state.stress.begin(), state.stress.end());
  write_array(file, "stress", 3, tensor, names);
  std::vector<std::int64_t> bodies(mesh.triangles.size(), 1), regions(mesh.triangles.size(), 0);
  for (std::size_t b = 0; b < parts.bodies.size(); ++b) {
    const BodyPart& part = parts.bodies[b];
    std::fill_n(bodies.begin() + part.first_triangle, part.triangle_count, static_cast<std::int64_t>(b) + 1);
  }
  std::copy(parts.region_of_triangle.begin(), parts.region_of_triangle.end(), regions.begin());
  write_array(file, "body", 1, bodies);
  write_array(file, "region", 1, regions);
  file.write("      </CellData>\n    </Piece>\n  </UnstructuredGrid>\n</VTKFile>\n");
  file.commit();
}

void write_pvd(const std::filesystem::path& path, const std::vector<VtuEntry>& entries) {
  AtomicFile file(path);
  write_head(file, "Collection");
  file.write("  <Collection>\n");
  for (const VtuEntry& entry : entries) {
    file.write(fmt::format("    <DataSet timestep=\"{:.17g}\" part=\"0\" file=\"{}\"/>\n", entry.t,
                           xml_text(entry.name)));
  }
  file.write("  </Collection>\n</VTKFile>\n");
  file.commit();
}

}  // namespace rheo
