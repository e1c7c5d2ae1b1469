// Values of options from their text.
//
// Errors   Failure(usage): "--option value: what is allowed"
#pragma once

#include <array>
#include <string>

#include "command_line.hpp"

namespace app {

double positive_number(const std::string& option, const std::string& text, const std::string& unit);
double step_value(const std::string& option, const std::string& text);           // "auto": 0
double checkpoint_interval(const std::string& option, const std::string& text);  // "never": infinite
double tolerance_value(const std::string& option, const std::string& text);
double accuracy_value(const std::string& option, const std::string& text);
int whole_number(const std::string& option, const std::string& text, int low, int high);
std::string picture_sizes();  // "from 240x160 to ...", of which picture_size() takes one
std::array<int, 2> picture_size(const std::string& option, const std::string& text);
ColorRange color_range(const std::string& option, const std::string& text);
rheo::IntegratorKind integrator_kind(const std::string& option, const std::string& text);
rheo::Kernel kernel_choice(const std::string& option, const std::string& text);
rheo::ColorBy color_by(const std::string& option, const std::string& text);
DrawBackend draw_backend(const std::string& option, const std::string& text);

// The names that these accept and that reports use.
const char* name_of(rheo::IntegratorKind kind);
const char* name_of(rheo::Kernel kernel);
const char* name_of(rheo::ColorBy color);
const char* name_of(DrawBackend backend);

}  // namespace app
