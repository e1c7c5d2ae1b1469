// The baseline: PNG by stb_image_write exactly as it comes (its own deflate at level 8, a filter chosen for
// each row).
#pragma once

#include <cstddef>
#include <filesystem>

#include "render/image.hpp"

bool write_png_by_stb(const std::filesystem::path& file, const render::Image& image);
std::size_t encode_png_by_stb(const render::Image& image);  // bytes of the file
