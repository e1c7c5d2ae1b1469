#include "stb_default.hpp"

#define STB_IMAGE_WRITE_STATIC
#define STB_IMAGE_WRITE_IMPLEMENTATION
#include <stb/stb_image_write.h>

bool write_png_by_stb(const std::filesystem::path& file, const render::Image& image) {
  return stbi_write_png(file.c_str(), image.width, image.height, 4, image.rgba.data(), image.width * 4) != 0;
}

std::size_t encode_png_by_stb(const render::Image& image) {
  int size = 0;
  unsigned char* bytes =
      stbi_write_png_to_mem(image.rgba.data(), image.width * 4, image.width, image.height, 4, &size);
  STBIW_FREE(bytes);
  return static_cast<std::size_t>(size);
}
