// The [[body]] tables of a scene file: several bodies as separate pieces of one mesh.
//
//   name, position = [x, y] (m), angle (rad, counter-clockwise), and all keys of a body (body_reader.hpp)
//
// A body's mesh is turned about its origin, then moved. Node numbers are the body's own; vectors of tractions
// and moves keep the scene's axes; regions are looked up before the body is placed. Edge groups get the
// body's name in front ("left block.top").
//
// Errors   as body_reader.hpp; keys of a body beside [[body]]
#pragma once

#include <string>

#include "io/allowance.hpp"
#include "io/toml_tree.hpp"
#include "rheo/scene.hpp"

namespace rheo {

Scene read_bodies(const TomlValue& root, const std::string& file, Allowance& allowance);

}  // namespace rheo
