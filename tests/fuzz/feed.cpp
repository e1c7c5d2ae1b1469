#include "feed.hpp"

#include <unistd.h>

#include <algorithm>
#include <fstream>
#include <vector>

#include "command_line.hpp"
#include "failure.hpp"
#include "memory_need.hpp"
#include "overrides.hpp"
#include "rheo/error.hpp"
#include "rheo/io/mesh_file.hpp"
#include "rheo/io/scene_file.hpp"
#include "rheo/io/scene_text.hpp"

namespace rheo::fuzz {
namespace {

namespace fs = std::filesystem;

// So little that a scene of many nodes is refused, not built: more of them would show nothing new.
constexpr ReadOptions narrow{.memory = 1e6};
// Names in messages are cut short.
constexpr std::size_t longest_message = 2000;

void check_message(std::string_view message) {
  const bool plain = std::none_of(message.begin(), message.end(),
                                  [](char c) { return static_cast<unsigned char>(c) < 0x20 || c == 0x7f; });
  if (message.empty()) throw Finding("an empty message");
  if (!plain) throw Finding("a message of several lines: " + std::string(message));
  if (message.size() > longest_message) throw Finding("a message without end: " + std::string(message));
}

// Runs a reader that may refuse.
template <typename Read>
Verdict verdict_of(Read&& read) {
  try {
    read();
    return Verdict::accepted;
  } catch (const Error& error) {
    check_message(error.what());
  } catch (const app::Failure& failure) {
    // Words of the command line stand in it as they were typed; the program blanks their line ends.
    if (std::string_view(failure.what()).empty()) throw Finding("an empty message");
  } catch (const Finding&) {
    throw;
  } catch (const std::exception& error) {
    throw Finding(std::string("no error of the reader: ") + error.what());
  }
  return Verdict::refused;
}

// What stands before a line of its own; it and that line are taken off `rest`. All of it where there is none.
std::string_view take_until(std::string_view& rest, std::string_view line) {
  const std::string mark = "\n" + std::string(line) + "\n";
  const std::size_t at = rest.find(mark);
  const std::string_view before = rest.substr(0, at);
  rest = at == std::string_view::npos ? std::string_view{} : rest.substr(at + mark.size());
  return before;
}

// The scene's own text; the files beside it are put into the sandbox.
std::string_view unpack(std::string_view bytes, const Sandbox& sandbox) {
  std::string_view mesh = bytes;
  std::string_view table = take_until(mesh, "@mesh");
  const std::string_view scene = take_until(table, "@table");
  sandbox.set("mesh.msh", mesh);
  sandbox.set("table.csv", table);
  return scene;
}

void check_text(const Scene& scene, const Sandbox& sandbox) {
  const std::string text = scene_text(scene);
  std::string again;
  try {
    // Points and triangles take more than the two numbers of a shape.
    again = scene_text(parse_scene(text, "written.toml", sandbox.folder(), {.memory = 1e9}));
  } catch (const Error& error) {
    throw Finding(std::string("the text of an accepted scene is refused: ") + error.what());
  }
  if (again != text)
    throw Finding("the text of an accepted scene is read as another scene: " + text + "\n" + again);
}

}  // namespace

Sandbox::Sandbox() : folder_(fs::temp_directory_path() / ("rheo_fuzz_" + std::to_string(getpid()))) {
  fs::create_directories(folder_);
}

Sandbox::~Sandbox() {
  std::error_code ignored;
  fs::remove_all(folder_, ignored);
}

void Sandbox::set(const std::string& name, std::string_view text) const {
  if (text.empty()) {
    fs::remove(folder_ / name);
    return;
  }
  std::ofstream(folder_ / name, std::ios::binary) << text;
}

Verdict feed_scene(std::string_view bytes, const Sandbox& sandbox) {
  const std::string text(unpack(bytes, sandbox));
  return verdict_of([&] { check_text(parse_scene(text, "scene.toml", sandbox.folder(), narrow), sandbox); });
}

Verdict feed_mesh(std::string_view bytes, const Sandbox&) {
  return verdict_of([&] {
    Mesh mesh = parse_msh(std::string(bytes), "mesh.msh", nullptr, 10.0 * narrow.memory);
    prepare(mesh, "mesh.msh");
    const std::vector<Edge> boundary = mesh.edge_groups.at("boundary");
    if (prepare(mesh) != 0 || mesh.edge_groups.at("boundary") != boundary)
      throw Finding("a prepared mesh is changed when it is prepared again");
  });
}

Verdict feed_command_line(std::string_view bytes, const Sandbox& sandbox) {
  std::string_view scene = bytes;
  std::string_view lines = take_until(scene, "@scene");
  const std::string path = (sandbox.folder() / "scene.toml").string();
  std::vector<std::string> words{"rheo"};
  while (!lines.empty()) {
    const std::size_t end = std::min(lines.find('\n'), lines.size());
    const std::string_view word = lines.substr(0, end);
    words.emplace_back(word == "SCENE" ? std::string_view(path) : word.substr(0, word.find('\0')));
    lines.remove_prefix(std::min(end + 1, lines.size()));
  }
  std::vector<char*> arguments;
  for (std::string& word : words) arguments.push_back(word.data());
  arguments.push_back(nullptr);
  return verdict_of([&] {
    std::optional<app::Options> options =
        app::read_command_line(static_cast<int>(words.size()), arguments.data());
    if (!options || options->scene != path) return;  // any other file is none of ours
    sandbox.set("scene.toml", unpack(scene, sandbox));
    options->read.memory = narrow.memory;
    options->read.outputs = max_outputs;
    options->read.outside = OutsideFiles::refused;
    app::require_memory(app::load_scene(*options), *options);
  });
}

}  // namespace rheo::fuzz
