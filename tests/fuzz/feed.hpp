// Bytes from anywhere into one reader of the program. It must make something of them or refuse them in one
// line; whatever else it does is a finding.
//
// Errors   Finding. Nothing else comes out: what a reader throws beside its own errors is a finding too
#pragma once

#include <filesystem>
#include <stdexcept>
#include <string>
#include <string_view>

namespace rheo::fuzz {

struct Finding : std::runtime_error {
  using std::runtime_error::runtime_error;
};

// A folder of its own for the files that a scene reads; gone with this.
class Sandbox {
 public:
  Sandbox();
  Sandbox(const Sandbox&) = delete;
  Sandbox& operator=(const Sandbox&) = delete;
  ~Sandbox();

  const std::filesystem::path& folder() const { return folder_; }
  // Without text the file is not there.
  void set(const std::string& name, std::string_view text) const;

 private:
  std::filesystem::path folder_;
};

enum class Verdict { accepted, refused };

// A scene, and behind the lines "@table" and "@mesh" the files table.csv and mesh.msh that it may name. One
// that is accepted is written as a scene file, too, and that file read again must give the same text.
Verdict feed_scene(std::string_view bytes, const Sandbox& sandbox);

// A Gmsh file.
Verdict feed_mesh(std::string_view bytes, const Sandbox& sandbox);

// The words of a command line, one a line, SCENE for the scene's path; behind the line "@scene" that scene,
// as above. What is accepted is loaded as the program would.
Verdict feed_command_line(std::string_view bytes, const Sandbox& sandbox);

}  // namespace rheo::fuzz
