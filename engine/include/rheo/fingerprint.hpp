// A number of 64 bits that tells contents apart: a checksum of bytes, and of the parts of a scene that its
// motion hangs on.
//
//   h <- rotate((h xor word) * prime, 29) for each word of 8 bytes; the length is the last word
//
// Each round is a bijection of h and of the word: contents that differ in one word never have the same
// number. Not against forgery.
//
// Source   the multiplier is that of FNV-1a, 64 bits (Fowler, Noll and Vo)
// Errors   none
#pragma once

#include <bit>
#include <cstdint>
#include <cstring>
#include <span>
#include <string_view>

#include "rheo/scene.hpp"

namespace rheo {

class Fingerprint {
 public:
  void add(std::uint64_t word) { hash_ = std::rotl((hash_ ^ word) * 0x100000001b3u, 29); }
  void add(std::int64_t word) { add(static_cast<std::uint64_t>(word)); }
  void add(int word) { add(static_cast<std::int64_t>(word)); }
  void add(double number) { add(std::bit_cast<std::uint64_t>(number)); }
  void add(std::string_view bytes) {
    const std::size_t size = bytes.size();
    for (; bytes.size() >= 8; bytes.remove_prefix(8)) add_word(bytes, 8);
    if (!bytes.empty()) add_word(bytes, bytes.size());
    add(static_cast<std::uint64_t>(size));
  }
  std::uint64_t value() const { return hash_; }

 private:
  void add_word(std::string_view bytes, std::size_t size) {
    std::uint64_t word = 0;
    std::memcpy(&word, bytes.data(), size);
    add(word);
  }
  std::uint64_t hash_ = 0xcbf29ce484222325u;
};

inline std::uint64_t checksum(std::string_view bytes) {
  Fingerprint fingerprint;
  fingerprint.add(bytes);
  return fingerprint.value();
}

// Of points, triangles and thickness.
std::uint64_t mesh_fingerprint(const Mesh& mesh);
// Of all that a scene's motion hangs on; not of names, notes, probes and pictures.
std::uint64_t motion_fingerprint(const Scene& scene);

}  // namespace rheo
