// What a scene file says of one body: [mesh], [edges], [material], [[region]], [[fix]], [[move]],
// [[constraint]],
// [[traction]], [[probe]]; at the top of the file, or in one of its [[body]] tables.
//
// Errors   Error::Kind::input, "file:line: [table] key = value: what is allowed"; Error::Kind::file for a
// file
//          that cannot be read
#pragma once

#include <string>
#include <vector>

#include "io/allowance.hpp"
#include "io/toml_tree.hpp"
#include "rheo/scene.hpp"

namespace rheo {

// The keys of a body.
const std::vector<std::string>& body_keys();

// A scene of that body alone, without title, body force, time and picture; its mesh as given, prepared.
// `owner`: what its tables' names begin with: "" or "body."; `line`: where it begins.
Scene read_body(const TomlValue& root, const std::string& file, Allowance& allowance,
                const std::string& owner, int line);

}  // namespace rheo
