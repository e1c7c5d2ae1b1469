// Scene files (TOML).
//
// Errors   Error::Kind::input: one line "file:line: [table] key = value: what is allowed" (with the nearest
// known key for
//          a misspelt one); Error::Kind::file where the file cannot be read
#pragma once

#include <filesystem>
#include <string>

#include "rheo/io/read_options.hpp"
#include "rheo/scene.hpp"

namespace rheo {

// A scene, its mesh prepared, its names resolved; paths in it are relative to its folder.
Scene read_scene(const std::filesystem::path& file, const ReadOptions& options = {});

// The same from text; `name` stands for the file in messages, `folder` is where relative paths start.
Scene parse_scene(const std::string& text, const std::string& name, const std::filesystem::path& folder,
                  const ReadOptions& options = {});

}  // namespace rheo
