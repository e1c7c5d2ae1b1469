// Files that appear whole or not at all: written aside as "NAME.part", renamed by commit().
//
// Errors   Error::Kind::file with the path and the system's reason
#pragma once

#include <cstdio>
#include <filesystem>
#include <string_view>

namespace rheo {

// What commit() waits for: a kill spares what the system has taken, a power cut only what is on the disk.
enum class Durability { in_system, on_disk };

class AtomicFile {
 public:
  explicit AtomicFile(std::filesystem::path path);
  AtomicFile(const AtomicFile&) = delete;
  AtomicFile& operator=(const AtomicFile&) = delete;
  ~AtomicFile();  // without commit(): the part is removed, an older file of that name stays

  void write(std::string_view bytes);
  void commit(Durability durability = Durability::in_system);

 private:
  std::filesystem::path path_;
  std::filesystem::path part_;
  std::FILE* file_ = nullptr;
};

}  // namespace rheo
