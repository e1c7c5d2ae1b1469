#include "decode.hpp"

#include <cstdint>
#include <fstream>
#include <iterator>
#include <vector>

#define STB_IMAGE_STATIC
#define STB_IMAGE_IMPLEMENTATION
#define STBI_ONLY_PNG
#include <stb/stb_image.h>

render::Image decode_png(std::span<const unsigned char> bytes, int* channels) {
  render::Image image;
  int stored = 0;
  unsigned char* pixels = stbi_load_from_memory(bytes.data(), static_cast<int>(bytes.size()), &image.width,
                                                &image.height, &stored, 4);
  if (channels) *channels = stored;
  if (!pixels) return {};
  image.rgba.assign(
      pixels, pixels + static_cast<std::size_t>(image.width) * static_cast<std::size_t>(image.height) * 4);
  stbi_image_free(pixels);
  return image;
}

render::Image read_png(const std::filesystem::path& file) {
  std::ifstream in(file, std::ios::binary);
  const std::vector<unsigned char> bytes{std::istreambuf_iterator<char>(in), {}};
  return decode_png(bytes);
}
