#include "rheo/io/checkpoint.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <memory>
#include <system_error>
#include <utility>

#include "rheo/error.hpp"
#include "rheo/fingerprint.hpp"
#include "rheo/io/atomic_file.hpp"
#include "rheo/io/bytes.hpp"

namespace rheo {
namespace {

namespace fs = std::filesystem;

constexpr std::string_view magic = "rheo ck\n";
constexpr std::uint32_t byte_order = 0x01020304;
constexpr const char* remedy = "take another checkpoint, or begin the run anew";

struct Header {
  char magic[8];
  std::uint32_t version, order;
  std::uint64_t length, mesh, motion;
};
static_assert(sizeof(Header) == 40);

[[noreturn]] void refuse(const fs::path& file, const std::string& what) {
  throw Error(Error::Kind::input, fmt::format("{}: {}", file.string(), what));
}

void put_state(ByteWriter& out, const SavedState& state) {
  out.put(state.t);
  out.put_list(state.u);
  out.put_list(state.v);
  for (const auto* branches : {&state.w_lambda, &state.w_mu}) {
    out.put(static_cast<std::uint64_t>(branches->size()));
    for (const std::vector<double>& w : *branches) out.put_list(w);
  }
  out.put(static_cast<std::uint64_t>(state.parts.size()));
  for (const SavedState::Part& part : state.parts) {
    out.put(static_cast<std::uint64_t>(part.lambda ? 1 : 0));
    out.put(static_cast<std::uint64_t>(part.material));
    out.put(static_cast<std::uint64_t>(part.branch));
    out.put_list(part.w);
  }
}

SavedState get_state(ByteReader& in) {
  SavedState state;
  state.t = in.get<double>();
  state.u = in.get_list<double>();
  state.v = in.get_list<double>();
  for (auto* branches : {&state.w_lambda, &state.w_mu})
    for (auto left = in.get<std::uint64_t>(); left > 0; --left) branches->push_back(in.get_list<double>());
  for (auto left = in.get<std::uint64_t>(); left > 0; --left) {
    SavedState::Part part;
    part.lambda = in.get<std::uint64_t>() != 0;
    part.material = static_cast<std::size_t>(in.get<std::uint64_t>());
    part.branch = static_cast<std::size_t>(in.get<std::uint64_t>());
    part.w = in.get_list<double>();
    state.parts.push_back(std::move(part));
  }
  return state;
}

// All blocks but the materials' own have as many numbers as u.
bool is_of_one_size(const SavedState& state) {
  const auto fits = [&](const std::vector<double>& x) { return x.size() == state.u.size(); };
  return fits(state.v) && std::ranges::all_of(state.w_lambda, fits) && std::ranges::all_of(state.w_mu, fits);
}

struct CloseFile {
  void operator()(std::FILE* file) const { std::fclose(file); }
};

// The header is judged before the rest is read: a huge file of something else costs nothing.
std::string checked_bytes(const fs::path& file) {
  const auto cannot_read = [&](int reason) {
    return Error(Error::Kind::file, fmt::format("{}: the checkpoint cannot be read: {}", file.string(),
                                                std::generic_category().message(reason)));
  };
  std::error_code error;
  if (fs::is_directory(file, error)) throw cannot_read(EISDIR);
  const std::unique_ptr<std::FILE, CloseFile> stream(std::fopen(file.c_str(), "rb"));
  if (!stream) throw cannot_read(errno);

  Header header{};
  errno = 0;
  const std::size_t begun = std::fread(&header, 1, sizeof header, stream.get());
  if (std::ferror(stream.get()) != 0) throw cannot_read(errno);
  if (begun == 0) refuse(file, fmt::format("is empty, not a checkpoint: {}", remedy));
  if (std::string_view(header.magic, std::min(begun, magic.size())) != magic.substr(0, begun))
    refuse(file, "is not a checkpoint: name the checkpoint.rheo that a run has left");
  if (begun < sizeof header) refuse(file, fmt::format("is truncated after {} bytes: {}", begun, remedy));
  if (header.order != byte_order)
    refuse(file, "is damaged, or of a machine with another byte order: go on with the run there");
  if (header.version != checkpoint_version)
    refuse(file, fmt::format("is a checkpoint of version {}, this rheo reads version {}: go on with the rheo "
                             "that wrote it",
                             header.version, checkpoint_version));
  const std::uintmax_t size = fs::file_size(file, error);
  if (error || size != header.length)
    refuse(file, fmt::format("is {}: it has {} of {} bytes: {}",
                             size < header.length ? "truncated" : "damaged", size, header.length, remedy));

  std::string bytes(reinterpret_cast<const char*>(&header), sizeof header);
  bytes.resize(static_cast<std::size_t>(size));
  errno = 0;
  const std::size_t rest = bytes.size() - sizeof header;
  if (std::fread(bytes.data() + sizeof header, 1, rest, stream.get()) != rest) throw cannot_read(errno);
  std::uint64_t sum = 0;
  if (rest < sizeof sum) refuse(file, fmt::format("is truncated: {}", remedy));
  std::memcpy(&sum, bytes.data() + bytes.size() - sizeof sum, sizeof sum);
  bytes.resize(bytes.size() - sizeof sum);
  if (checksum(bytes) != sum)
    refuse(file, fmt::format("is damaged: its checksum is not that of its content: {}", remedy));
  return bytes;
}

}  // namespace

void write_checkpoint(const fs::path& file, Simulation& simulation, std::string_view companion) {
  const Snapshot snapshot = simulation.snapshot();
  ByteWriter rest;
  put_state(rest, snapshot.state);
  rest.put_text(snapshot.course);
  rest.put_text(companion);

  const Scene& scene = simulation.scene();
  Header header{};
  std::memcpy(header.magic, magic.data(), sizeof header.magic);
  header.version = checkpoint_version;
  header.order = byte_order;
  header.length = sizeof header + rest.bytes().size() + sizeof(std::uint64_t);
  header.mesh = mesh_fingerprint(scene.mesh);
  header.motion = motion_fingerprint(scene);
  ByteWriter all;
  all.put(header);
  std::string bytes = all.take() + rest.bytes();
  const std::uint64_t sum = checksum(bytes);
  bytes.append(reinterpret_cast<const char*>(&sum), sizeof sum);

  AtomicFile out(file);
  out.write(bytes);
  out.commit(Durability::on_disk);
}

Checkpoint read_checkpoint(const fs::path& file) {
  const std::string bytes = checked_bytes(file);
  const std::string name = file.string();
  ByteReader in(bytes, name);
  const auto header = in.get<Header>();
  Checkpoint checkpoint{file, header.mesh, header.motion, {get_state(in), {}}, {}};
  checkpoint.snapshot.course = in.get_text();
  checkpoint.companion = in.get_text();
  in.expect_end();
  if (!is_of_one_size(checkpoint.snapshot.state))
    refuse(file, fmt::format("holds blocks of different sizes: {}", remedy));
  return checkpoint;
}

void go_on(Simulation& simulation, const Checkpoint& checkpoint) {
  const Scene& scene = simulation.scene();
  if (checkpoint.mesh != mesh_fingerprint(scene.mesh))
    refuse(checkpoint.file, fmt::format("is of another mesh than this scene's: {}", remedy));
  if (checkpoint.motion != motion_fingerprint(scene))
    refuse(checkpoint.file,
           "is of another scene, or of other settings of its time: name those of its run, or begin anew");
  try {
    simulation.restore(checkpoint.snapshot);
  } catch (const Error& error) {
    refuse(checkpoint.file, error.what());
  }
}

void begin_from(Simulation& simulation, const Checkpoint& checkpoint) {
  const Mesh& mesh = simulation.scene().mesh;
  if (checkpoint.mesh != mesh_fingerprint(mesh) ||
      checkpoint.snapshot.state.u.size() != 2 * mesh.points.size())
    refuse(checkpoint.file, "is of another mesh than this scene's: a start needs one of the same mesh");
  SavedState start = checkpoint.snapshot.state;
  start.t = 0.0;
  simulation.resume(start);
}

}  // namespace rheo
