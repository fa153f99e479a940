// SPDX-License-Identifier: Apache-2.0
#include "app/recording/recording_file.h"

#include <fcntl.h>
#include <hdf5.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <memory>
#include <new>
#include <tuple>
#include <vector>

#include "app/recording/trajectory_hdf5.h"

namespace mercury {
namespace {

constexpr haddr_t largest_address = (haddr_t{1} << 63) - 1;

struct WrittenFile {
  H5FD_t base;  // of HDF5, first
  int descriptor;
  WriteFailure* failure;
  haddr_t allocated, end;  // [bytes]
  dev_t device;
  ino_t inode;
  struct Late {
    haddr_t at;
    std::vector<char> bytes;
  };
  std::vector<Late> late;  // written after the failure, in that order
};

WrittenFile& file_of(H5FD_t* file) { return *reinterpret_cast<WrittenFile*>(file); }
const WrittenFile& file_of(const H5FD_t* file) { return *reinterpret_cast<const WrittenFile*>(file); }

// Notes errno unless there was a failure before.
void note_errno(WriteFailure& failure) {
  if (failure.number == 0) failure.number = errno != 0 ? errno : EIO;
}

H5FD_t* open_written_file(const char* name, unsigned flags, hid_t access, haddr_t) {
  const auto* failure = static_cast<WriteFailure* const*>(H5Pget_driver_info(access));
  if (!failure) return nullptr;
  int mode = (flags & H5F_ACC_RDWR) ? O_RDWR : O_RDONLY;
  if (flags & H5F_ACC_TRUNC) mode |= O_TRUNC;
  if (flags & H5F_ACC_CREAT) mode |= O_CREAT;
  if (flags & H5F_ACC_EXCL) mode |= O_EXCL;
  (*failure)->number = 0;  // HDF5 first tries whether there is such a file
  const int descriptor = open(name, mode | O_CLOEXEC, 0666);
  struct stat status {};
  std::unique_ptr<WrittenFile> file(new (std::nothrow) WrittenFile{});
  if (descriptor < 0 || !file || fstat(descriptor, &status) != 0) {
    note_errno(**failure);
    if (descriptor >= 0) close(descriptor);
    return nullptr;
  }
  file->descriptor = descriptor;
  file->failure = *failure;
  file->end = static_cast<haddr_t>(status.st_size);
  file->device = status.st_dev;
  file->inode = status.st_ino;
  return &file.release()->base;
}

herr_t close_written_file(H5FD_t* base) {
  const std::unique_ptr<WrittenFile> file(&file_of(base));
  if (close(file->descriptor) != 0) note_errno(*file->failure);  // some network drives say only now that they are full
  return 0;
}

int compare_files(const H5FD_t* first, const H5FD_t* second) {
  const auto key = [](const H5FD_t* file) { return std::tuple(file_of(file).device, file_of(file).inode); };
  return key(first) < key(second) ? -1 : key(second) < key(first) ? 1 : 0;
}

// Those of HDF5's usual driver, whose format this is.
herr_t query_features(const H5FD_t*, unsigned long* flags) {
  *flags = H5FD_FEAT_AGGREGATE_METADATA | H5FD_FEAT_ACCUMULATE_METADATA | H5FD_FEAT_DATA_SIEVE |
           H5FD_FEAT_AGGREGATE_SMALLDATA | H5FD_FEAT_POSIX_COMPAT_HANDLE | H5FD_FEAT_SUPPORTS_SWMR_IO |
           H5FD_FEAT_DEFAULT_VFD_COMPATIBLE;
  return 0;
}

haddr_t allocated_end(const H5FD_t* file, H5FD_mem_t) { return file_of(file).allocated; }
herr_t set_allocated_end(H5FD_t* file, H5FD_mem_t, haddr_t end) {
  file_of(file).allocated = end;
  return 0;
}
haddr_t written_end(const H5FD_t* file, H5FD_mem_t) { return file_of(file).end; }
herr_t descriptor_of(H5FD_t* file, hid_t, void** descriptor) {
  *descriptor = &file_of(file).descriptor;
  return 0;
}

herr_t read_bytes(H5FD_t* base, H5FD_mem_t, hid_t, haddr_t at, std::size_t size, void* content) {
  const WrittenFile& file = file_of(base);
  char* bytes = static_cast<char*>(content);
  std::size_t done = 0;
  while (done < size) {
    const ssize_t count = pread(file.descriptor, bytes + done, size - done, static_cast<off_t>(at + done));
    if (count < 0 && errno == EINTR) continue;
    if (count < 0) return -1;
    if (count == 0) break;
    done += static_cast<std::size_t>(count);
  }
  std::fill(bytes + done, bytes + size, '\0');  // after the end
  for (const WrittenFile::Late& late : file.late) {
    const haddr_t begin = std::max(at, late.at), end = std::min(at + size, late.at + late.bytes.size());
    if (begin < end) std::memcpy(bytes + (begin - at), late.bytes.data() + (begin - late.at), end - begin);
  }
  return 0;
}

void write_all(WrittenFile& file, haddr_t at, const char* bytes, std::size_t size) {
  while (size > 0 && file.failure->number == 0) {
    const ssize_t count = pwrite(file.descriptor, bytes, size, static_cast<off_t>(at));
    if (count < 0 && errno == EINTR) continue;
    if (count <= 0) return note_errno(*file.failure);
    at += static_cast<haddr_t>(count);
    bytes += count;
    size -= static_cast<std::size_t>(count);
  }
}

herr_t write_bytes(H5FD_t* base, H5FD_mem_t, hid_t, haddr_t at, std::size_t size, const void* content) {
  WrittenFile& file = file_of(base);
  const char* bytes = static_cast<const char*>(content);
  write_all(file, at, bytes, size);
  file.end = std::max(file.end, at + size);
  if (file.failure->number != 0) try {
      file.late.push_back({at, {bytes, bytes + size}});
    } catch (const std::bad_alloc&) {
      return -1;
    }
  return 0;
}

herr_t truncate_file(H5FD_t* base, hid_t, hbool_t) {
  WrittenFile& file = file_of(base);
  if (file.allocated == file.end) return 0;
  if (file.failure->number == 0 && ftruncate(file.descriptor, static_cast<off_t>(file.allocated)) != 0)
    note_errno(*file.failure);
  file.end = file.allocated;
  return 0;
}

// Some network drives lack locks. A program that watches for recordings may have locked the file as soon as it was
// there: it finds nothing in it yet, and only this program writes it.
herr_t lock_file(H5FD_t* file, hbool_t) {
  const int result = flock(file_of(file).descriptor, LOCK_EX | LOCK_NB);
  return result == 0 || errno == EWOULDBLOCK || errno == ENOSYS ? 0 : -1;
}
herr_t unlock_file(H5FD_t* file) {
  const int result = flock(file_of(file).descriptor, LOCK_UN);
  return result == 0 || errno == ENOSYS ? 0 : -1;
}

H5FD_class_t driver_of_recordings() {
  H5FD_class_t driver{};
#if H5_VERSION_GE(1, 13, 0)
  driver.version = H5FD_CLASS_VERSION;
  driver.value = static_cast<H5FD_class_value_t>(510);
#endif
  driver.name = "mercury";
  driver.maxaddr = largest_address;
  driver.fc_degree = H5F_CLOSE_WEAK;
  driver.fapl_size = sizeof(WriteFailure*);
  driver.open = open_written_file;
  driver.close = close_written_file;
  driver.cmp = compare_files;
  driver.query = query_features;
  driver.get_eoa = allocated_end;
  driver.set_eoa = set_allocated_end;
  driver.get_eof = written_end;
  driver.get_handle = descriptor_of;
  driver.read = read_bytes;
  driver.write = write_bytes;
  driver.truncate = truncate_file;
  driver.lock = lock_file;
  driver.unlock = unlock_file;
  constexpr H5FD_mem_t map[] = H5FD_FLMAP_DICHOTOMY;
  std::ranges::copy(map, driver.fl_map);
  return driver;
}

}  // namespace

void set_recording_file(hdf5::Id access, WriteFailure& failure) {
  static const H5FD_class_t description = driver_of_recordings();
  static const hid_t id = hdf5::checked(H5FDregister(&description));
  const WriteFailure* const information = &failure;
  hdf5::checked(H5Pset_driver(access, id, &information));
}

}  // namespace mercury
