// A file that grows through a run as NAME.part and becomes NAME at its end: whole or not at all, like
// rheo::AtomicFile, but one that a later run can take up again at a length that it once had.
//
// Without keep() the part is removed with this object, whatever happened; killed, it stays.
//
// Errors   Failure(file): the path and the system's reason, or that the part is not the one that was kept
#pragma once

#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <string_view>

#include "rheo/fingerprint.hpp"

namespace app {

class GrowingFile {
 public:
  // Which content a file had when it was kept.
  struct Mark {
    std::uint64_t length = 0;
    std::uint64_t pieces = 0;  // appended
    std::uint64_t checksum = 0;
  };

  explicit GrowingFile(std::filesystem::path path);
  GrowingFile(const GrowingFile&) = delete;
  GrowingFile& operator=(const GrowingFile&) = delete;
  ~GrowingFile();

  // Takes up the part that was kept, cut to what it was; the whole file where it has become that since. It is
  // read in the pieces in which it was appended: lines where `piece` is 0, else pieces of so many bytes;
  // see(piece) is called for each.
  template <class See>
  GrowingFile(std::filesystem::path path, const Mark& mark, std::size_t piece, const See& see)
      : path_(std::move(path)) {
    open_kept(mark.length);
    std::string held;
    for (std::uint64_t done = 0; done < mark.length;) {
      const std::size_t length = next_piece(done, mark.length, piece, held);
      see(std::string_view(held).substr(0, length));
      fingerprint_.add(std::string_view(held).substr(0, length));
      ++pieces_;
      done += length;
    }
    take_kept(mark);
  }

  void append(std::string_view piece);
  // Of what was appended.
  void read(std::uint64_t offset, std::span<char> out);
  // All so far is on the disk, and the part stays there from now on. Of a file that is whole: what it is.
  Mark keep();
  // It goes at once, kept or not; nothing is read or written afterwards.
  void discard();
  void commit();

 private:
  void open_kept(std::uint64_t length);
  std::size_t next_piece(std::uint64_t offset, std::uint64_t end, std::size_t piece, std::string& held);
  void take_kept(const Mark& mark);
  void flush();
  [[noreturn]] void refuse(const char* what, int reason) const;

  std::filesystem::path path_;
  std::string buffer_;
  std::uint64_t length_ = 0;  // with the buffer
  std::uint64_t pieces_ = 0;
  rheo::Fingerprint fingerprint_;
  int file_ = -1;
  bool kept_ = false;
  bool was_whole_ = false;
};

}  // namespace app
