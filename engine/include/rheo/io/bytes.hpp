// Numbers and texts as bytes one after the other, and back: what checkpoints are made of.
//
//   a number: its bytes; a list: its length in a u64, then its elements; a text likewise
//
// Byte order and sizes are this machine's: whoever keeps bytes in a file says which (checkpoint.hpp).
// Errors   ByteReader: Error::Kind::input, "NAME: ...", where the bytes end too early or too late
#pragma once

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <span>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>
#include <vector>

#include "rheo/error.hpp"

namespace rheo {

// What bytes can stand for: no pointers, no padding to speak of.
template <class T>
concept Plain = std::is_trivially_copyable_v<T> && !std::is_pointer_v<T>;

class ByteWriter {
 public:
  template <Plain T>
  void put(const T& value) {
    append(&value, sizeof value);
  }
  template <Plain T, std::size_t size>
  void put_list(std::span<T, size> values) {
    put(static_cast<std::uint64_t>(values.size()));
    append(values.data(), values.size_bytes());
  }
  template <Plain T>
  void put_list(const std::vector<T>& values) {
    put_list(std::span(values));
  }
  void put_text(std::string_view text) { put_list(std::span(text)); }

  const std::string& bytes() const { return bytes_; }
  std::string take() { return std::move(bytes_); }

 private:
  void append(const void* data, std::size_t size) {
    if (size > 0) bytes_.append(static_cast<const char*>(data), size);
  }
  std::string bytes_;
};

class ByteReader {
 public:
  // Both must outlive this; the name stands for their place in messages.
  ByteReader(std::string_view bytes, std::string_view name) : bytes_(bytes), name_(name) {}

  template <Plain T>
  T get() {
    T value;
    std::memcpy(&value, next(sizeof value), sizeof value);
    return value;
  }
  template <Plain T>
  std::vector<T> get_list() {
    const auto count = get<std::uint64_t>();
    if (count > bytes_.size() / sizeof(T)) refuse("a list in it goes beyond its end");
    std::vector<T> values(static_cast<std::size_t>(count));
    if (count > 0) std::memcpy(values.data(), next(values.size() * sizeof(T)), values.size() * sizeof(T));
    return values;
  }
  // Into memory of the right size.
  template <Plain T>
  void get_list(std::span<T> values) {
    if (get<std::uint64_t>() != values.size()) refuse("a list in it has another length than this scene's");
    if (!values.empty()) std::memcpy(values.data(), next(values.size_bytes()), values.size_bytes());
  }
  std::string get_text() {
    const std::vector<char> text = get_list<char>();
    return {text.begin(), text.end()};
  }
  void expect_end() const {
    if (!bytes_.empty()) refuse("there is more in it than belongs there");
  }

 private:
  [[noreturn]] void refuse(const char* what) const {
    throw Error(Error::Kind::input,
                std::string(name_) + ": " + what + ": take another checkpoint, or begin the run anew");
  }
  const char* next(std::size_t size) {
    if (size > bytes_.size()) refuse("it ends too early");
    const char* const here = bytes_.data();
    bytes_.remove_prefix(size);
    return here;
  }

  std::string_view bytes_;
  std::string_view name_;
};

}  // namespace rheo
