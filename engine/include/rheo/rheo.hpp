// All of the engine's public headers but the file formats (rheo/io/).
#pragma once

#include "rheo/accuracy.hpp"
#include "rheo/deformation.hpp"
#include "rheo/dense_flow.hpp"
#include "rheo/elastic_constants.hpp"
#include "rheo/error.hpp"
#include "rheo/integrator.hpp"
#include "rheo/live.hpp"
#include "rheo/material.hpp"
#include "rheo/material_presets.hpp"
#include "rheo/mesh.hpp"
#include "rheo/prony_fit.hpp"
#include "rheo/relaxation.hpp"
#include "rheo/scene.hpp"
#include "rheo/shapes.hpp"
#include "rheo/simulation.hpp"
#include "rheo/stability.hpp"
