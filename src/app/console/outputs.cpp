#include "app/console/outputs.h"

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <filesystem>
#include <map>
#include <utility>

#include "elastogear/base/collectively.h"
#include "elastogear/base/error.h"
#include "elastogear/base/file.h"

namespace elastogear::app {
namespace {

struct Input {
  std::string file, whence;
};

bool same_file(const std::string& a, const std::string& b) {
  std::error_code error;
  return !a.empty() && !b.empty() && std::filesystem::equivalent(a, b, error) && !error;
}

// Words of options that name no file do no harm here.
std::vector<Input> inputs(const Options& options, const std::vector<Outputs>& outputs,
                          const std::vector<std::string>& data) {
  std::vector<Input> all;
  for (const std::string& file : data) all.push_back({file, "reads it"});
  for (const std::string& file : options.files()) all.push_back({file, "reads its options there"});
  for (const auto& [name, value] : options.given_to_verb()) {
    const auto is_output = [&name = name](const Outputs& output) { return output.option == name; };
    if (std::any_of(outputs.begin(), outputs.end(), is_output)) continue;
    std::vector<std::string> words = options.list(name);
    words.push_back(value);
    for (const std::string& word : words) all.push_back({word, "reads it, option -" + name});
  }
  return all;
}

// The absolute path of a file without links; the file need not exist.
std::string whole_path(const std::string& file) {
  std::error_code unknown;
  return std::filesystem::weakly_canonical(std::filesystem::absolute(place_of_output(file)), unknown)
      .string();
}

// Is the open file still the one under this name, or has its last owner removed it?
bool is_at(const std::string& path, int file) {
  struct stat open {
  }, named{};
  return fstat(file, &open) == 0 && stat(path.c_str(), &named) == 0 && open.st_ino == named.st_ino &&
         open.st_dev == named.st_dev;
}

std::string owner(int file) {
  char text[128] = {};
  const auto n = pread(file, text, sizeof text - 1, 0);
  return n > 0 ? " (" + std::string(text) + ")" : "";
}

// A lock is empty or signed; whatever else has its name is a file of the user's.
constexpr const char* kSignature = "process ";

bool is_lock(int file) {
  struct stat status {};
  if (fstat(file, &status) != 0 || !S_ISREG(status.st_mode)) return false;
  const std::string signature = kSignature;
  std::string text(signature.size(), ' ');
  return status.st_size == 0 ||
         (pread(file, text.data(), text.size(), 0) == static_cast<ssize_t>(text.size()) && text == signature);
}

void sign(int file) {
  char host[64] = {};
  gethostname(host, sizeof host - 1);
  const std::string text = kSignature + std::to_string(getpid()) + " on " + host;
  // what cannot be written is missing in the message of another run alone
  if (ftruncate(file, 0) == 0 && pwrite(file, text.data(), text.size(), 0) < 0) return;
}

}  // namespace

void require_different(const Options& options, const std::vector<Outputs>& outputs) {
  std::map<std::string, std::string> options_of;  // by path
  for (const Outputs& output : outputs)
    for (const std::string& file : output.files) {
      const auto [other, is_new] = options_of.emplace(whole_path(file), output.option);
      if (is_new) continue;
      require(other->second != output.option, options.label(output.option), ": '", file,
              "' is the name of two files that this run writes; give another one");
      fail(options.label(output.option), ": '", file, "' is the file of ", options.label(other->second),
           ", too; give them two names");
    }
}

void protect_inputs(const Options& options, const std::vector<Outputs>& outputs,
                    const std::vector<std::string>& data) {
  const std::vector<Input> all = inputs(options, outputs, data);
  for (const Outputs& output : outputs)
    for (const std::string& file : output.files) {
      place_of_output(file);  // an Error where nothing can be written
      for (const Input& input : all)
        require(!same_file(file, input.file), options.label(output.option), ": would overwrite ", file,
                input.file == file ? "" : ", the same file as " + input.file, "; this run ", input.whence);
    }
  require_different(options, outputs);
}

OutputLock::OutputLock(const std::string& path, MPI_Comm comm) {
  collectively(comm, [&] {
    int rank = 0;
    MPI_Comm_rank(comm, &rank);
    if (rank == 0) take(path);
  });
}

void OutputLock::take(const std::string& output) {
  place_of_output(output);  // an Error where nothing can be written
  path_ = output + ".lock";
  do {
    if (file_ >= 0) close(file_);
    file_ = open(path_.c_str(), O_RDWR | O_CREAT | O_CLOEXEC | O_NOFOLLOW | O_NONBLOCK, 0666);
    const bool in_the_way = file_ < 0 ? errno == ELOOP || errno == EISDIR || errno == ENXIO : !is_lock(file_);
    if (file_ >= 0 && in_the_way) close(std::exchange(file_, -1));
    require(!in_the_way, path_, ": is no lock of this program, which needs the name while it writes ", output,
            ": move it, or give another output");
    require(file_ >= 0, output, ": cannot be written: ", std::strerror(errno));
    if (flock(file_, LOCK_EX | LOCK_NB) == 0) continue;
    if (errno != EWOULDBLOCK) break;  // no locks here
    const std::string other = owner(file_);
    close(std::exchange(file_, -1));
    fail(output, ": another run writes it now", other, "; wait for its end, or give another output");
  } while (!is_at(path_, file_));
  sign(file_);
}

OutputLock::~OutputLock() {
  if (file_ < 0) return;
  unlink(path_.c_str());
  close(file_);
}

}  // namespace elastogear::app
