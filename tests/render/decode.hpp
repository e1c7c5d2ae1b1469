// Reads PNG by stb_image, independently of the encoder under test.
#pragma once

#include <filesystem>
#include <span>

#include "render/image.hpp"

// Empty when it is no PNG. `channels`: as stored in the file.
render::Image decode_png(std::span<const unsigned char> bytes, int* channels = nullptr);
render::Image read_png(const std::filesystem::path& file);
