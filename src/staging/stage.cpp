// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cerrno>

#include <fcntl.h>
#include <linux/openat2.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <meshfarm/staging/stage.hpp>
#include <meshfarm/staging/staged_writer.hpp>
#include <meshfarm/util/checksum.hpp>
#include <meshfarm/util/errors.hpp>

namespace meshfarm {
namespace {

/// Opens `name` beneath `root`: no symbolic link and no ".." can lead outside. On kernels without
/// openat2, only the grammar of names, which allows neither, protects.
Fd open_beneath(const std::filesystem::path& root, const std::string& name) {
  const Fd folder(::open(root.c_str(), O_PATH | O_DIRECTORY | O_CLOEXEC));
  if (!folder) throw_errno("cannot open", root);
  open_how how{};
  how.flags = O_RDONLY | O_CLOEXEC;
  how.resolve = RESOLVE_BENEATH | RESOLVE_NO_SYMLINKS | RESOLVE_NO_MAGICLINKS;
  Fd fd(static_cast<int>(::syscall(SYS_openat2, folder.get(), name.c_str(), &how, sizeof how)));
  if (!fd && errno == ENOSYS) {
    fd = Fd(::openat(folder.get(), name.c_str(), O_RDONLY | O_NOFOLLOW | O_CLOEXEC));
  }
  if (!fd) throw_errno("cannot open", root / name);
  return fd;
}

/// Lists a folder: an NFS client with a cached "not found" then asks the server again.
void refresh(const std::filesystem::path& folder) {
  std::error_code ignored;
  for (auto entry = std::filesystem::directory_iterator(folder, ignored);
       !ignored && entry != std::filesystem::directory_iterator(); entry.increment(ignored)) {
  }
}

Fd open_once(const std::filesystem::path& root, const FileRef& file) {
  const std::filesystem::path path = root / file.name;
  Fd fd = open_beneath(root, file.name);
  const std::uint64_t size = file_size(fd.get(), path);
  if (size != file.size) {
    throw DataError(path.string() + ": " + std::to_string(size) + " bytes where " +
                    std::to_string(file.size) + " were promised");
  }
  return fd;
}

constexpr std::size_t k_piece = std::size_t{1} << 20;

void tell_moved(const ReadPatience& patience, std::uint64_t bytes) {
  if (patience.moved) patience.moved(bytes);
}

std::string read_once(const std::filesystem::path& root, const FileRef& file,
                      const FileSection& section, const ReadPatience& patience) {
  const std::filesystem::path path = root / file.name;
  const Fd fd = open_once(root, file);
  if (section.offset > file.size || section.size > file.size - section.offset) {
    throw DataError(path.string() + ": has no section at byte " + std::to_string(section.offset));
  }
  std::string bytes(section.size, '\0');
  std::size_t done = 0;
  while (done < bytes.size()) {
    const std::size_t want = std::min(k_piece, bytes.size() - done);
    const std::size_t got =
        read_at(fd.get(), section.offset + done, {bytes.data() + done, want}, path);
    tell_moved(patience, got);
    done += got;
    if (got < want) break;
  }
  if (done != section.size || checksum(bytes) != section.hash) {
    throw DataError(path.string() + ": damaged (its checksum is not the promised one)");
  }
  return bytes;
}

void verify_once(const std::filesystem::path& root, const FileRef& file,
                 const ReadPatience& patience) {
  const std::filesystem::path path = root / file.name;
  const Fd fd = open_once(root, file);
  Checksum sum;
  std::string piece(std::min<std::uint64_t>(k_piece, file.size), '\0');
  for (std::uint64_t left = file.size; left > 0; left -= piece.size()) {
    piece.resize(std::min<std::uint64_t>(piece.size(), left));
    if (read_up_to(fd.get(), piece, path) < piece.size()) break;  // the checksum shows it
    tell_moved(patience, piece.size());
    sum.add(piece);
  }
  if (sum.value() != file.hash) {
    throw DataError(path.string() + ": damaged (its checksum is not the promised one)");
  }
}

/// Retries what NFS may have answered too early.
template <class Try>
auto patiently(const Stage& stage, const FileRef& file, const ReadPatience& patience,
               const Try& try_once) {
  const auto name = parse_staged_name(file.name);
  if (!name) throw DataError("'" + file.name + "' is not a staged name");
  Waiting waiting(patience);
  for (int wrong = 0;;) {  // attempts at an existing file
    try {
      return try_once();
    } catch (const IoError& error) {
      if (!waiting.again(error)) throw UnreadIoError(error);
    } catch (const DataError& error) {
      if (++wrong >= patience.attempts) throw UnreadDataError(error.what());
      waiting.pause();
    }
    refresh(stage.path(*name).parent_path());
  }
}

template <class Name, class Number>
auto numbers_in(const std::filesystem::path& root, std::string_view folder, Number number) {
  std::vector<decltype(number(Name{}))> found;
  std::error_code error;
  for (const auto& entry : std::filesystem::directory_iterator(root / folder, error)) {
    const auto name =
        parse_staged_name(std::string(folder) + "/" + entry.path().filename().string());
    if (name && std::holds_alternative<Name>(*name)) found.push_back(number(std::get<Name>(*name)));
  }
  if (error) throw IoError("cannot list", root / folder, error.value());
  std::sort(found.begin(), found.end());
  return found;
}

/// The type of the file there. An error is not the same as "nothing there".
std::filesystem::file_type type_of(const std::filesystem::path& path) {
  std::error_code error;
  const auto type = std::filesystem::status(path, error).type();
  if (type == std::filesystem::file_type::none) {
    throw IoError("cannot look at", path, error.value());
  }
  return type;
}

bool has_log(const std::filesystem::path& root) {
  std::error_code error;
  return std::filesystem::is_directory(root / "log", error);
}

}  // namespace

Stage Stage::create(const std::filesystem::path& root) {
  std::error_code error;
  std::filesystem::create_directories(root, error);
  for (const std::string_view folder : k_stage_folders) {
    if (!error) std::filesystem::create_directories(root / folder, error);
  }
  if (error) throw IoError("cannot make the stage", root, error.value());
  return Stage(root);
}

Stage Stage::open(const std::filesystem::path& root, const ReadPatience& patience) {
  Stage stage(root);
  outlast(patience, [&] {
    if (type_of(root) != std::filesystem::file_type::directory) {
      throw DataError(root.string() + ": no such folder; make a stage with 'meshfarm cut'");
    }
    if (type_of(stage.path(ManifestName{})) == std::filesystem::file_type::not_found) {
      throw DataError(root.string() +
                      ": holds no manifest: it is not a stage, or its cut did not finish; make it "
                      "with 'meshfarm cut'");
    }
  });
  return stage;
}

bool Stage::has_manifest() const {
  std::error_code error;
  return std::filesystem::exists(path(ManifestName{}), error);
}

FileRef Stage::publish(const StagedName& name, std::string_view bytes,
                       std::string_view unique) const {
  StagedWriter file(*this, name, unique);
  file.write(bytes);
  return file.commit();
}

bool Stage::publish_new(const StagedName& name, std::string_view bytes,
                        std::string_view unique) const {
  StagedWriter file(*this, name, unique);
  file.write(bytes);
  return file.commit_new();
}

std::string Stage::read(const FileRef& file, const ReadPatience& patience) const {
  return read(file, {0, file.size, file.hash}, patience);
}

std::string Stage::read(const FileRef& file, const FileSection& section,
                        const ReadPatience& patience) const {
  return patiently(*this, file, patience,
                   [&] { return read_once(root_, file, section, patience); });
}

void Stage::verify(const FileRef& file, const ReadPatience& patience) const {
  patiently(*this, file, patience, [&] { verify_once(root_, file, patience); });
}

Fd Stage::open_told(const FileRef& file, const ReadPatience& patience) const {
  return patiently(*this, file, patience, [&] { return open_once(root_, file); });
}

std::string Stage::read(const StagedName& name, const ReadPatience& patience) const {
  return outlast(patience,
                 [&] { return read_file(open_beneath(root_, to_string(name)).get(), path(name)); });
}

std::vector<std::uint32_t> Stage::journals() const {
  return numbers_in<JournalName>(root_, "journal", [](JournalName n) { return n.number; });
}

std::vector<std::uint32_t> Stage::epochs() const {
  return numbers_in<EndpointName>(root_, "control", [](EndpointName n) { return n.epoch; });
}

std::vector<std::uint32_t> Stage::traces() const {
  if (!has_log(root_)) return {};
  return numbers_in<TraceName>(root_, "log", [](TraceName n) { return n.epoch; });
}

std::vector<std::uint32_t> Stage::summaries() const {
  if (!has_log(root_)) return {};
  return numbers_in<SummaryName>(root_, "log", [](SummaryName n) { return n.number; });
}

std::vector<std::uint64_t> Stage::hosts() const {
  return numbers_in<HostName>(root_, "control", [](HostName n) { return n.boot; });
}

void Stage::remove(const StagedName& name) const noexcept {
  std::error_code ignored;
  std::filesystem::remove(path(name), ignored);
}

namespace {

/// A file of a stage, or a leftover temporary file of one.
bool is_staged(const std::string& folder, const std::string& name) {
  const bool is_temporary =
      name.starts_with(".") && (name.ends_with(".tmp") || name.ends_with(".claim"));
  if (folder.empty()) {
    const std::string of = is_temporary ? name.substr(1, name.find('.', 1) - 1) : name;
    return parse_staged_name(of).has_value();
  }
  std::string path = folder;
  path.append("/").append(name);
  return is_temporary || parse_staged_name(path).has_value();
}

}  // namespace

void remove_stage(const std::filesystem::path& root) {
  std::error_code ignored;
  const auto remove_staged = [&](const std::string& folder) {
    for (const auto& entry : std::filesystem::directory_iterator(root / folder, ignored)) {
      const std::string name = entry.path().filename().string();
      if (is_staged(folder, name)) std::filesystem::remove(entry.path(), ignored);
    }
  };
  for (const std::string_view folder : k_stage_folders) {
    remove_staged(std::string(folder));
    std::filesystem::remove(root / folder, ignored);
  }
  remove_staged("");
  std::filesystem::remove(root, ignored);
}

}  // namespace meshfarm
