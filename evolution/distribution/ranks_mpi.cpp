// SPDX-License-Identifier: Apache-2.0
// Ranks by MPI. All messages are bytes:
//
//   rank 0                          the others
//   work  genomes, limits    ---->
//   stop                     ---->  (while they work, if the user interrupts)
//                            <----  result  what became of it, assessments
//   end                      ---->
//
// Every `work` is answered by one `result`, whatever happens, so nobody waits for a message that does not come. Waiting
// looks for messages in turns with short sleeps; MPI would keep a core busy.
//
// If a rank is lost, the launcher asks the others to end, and kills them soon after. Rank 0 then waits for answers only
// as long as ranks need to stop, and the others for a message of rank 0.
#define OMPI_SKIP_MPICXX 1
#include <mpi.h>

#include <chrono>
#include <limits>
#include <optional>
#include <stdexcept>
#include <thread>
#include <utility>

#include "evolution/distribution/ranks.h"
#include "evolution/run_folder/generation_record.h"
#include "evolution/run_folder/run_file.h"
#include "mercury/error.h"
#include "robots/bytes.h"

namespace mercury {
namespace {

enum Tag { work_tag = 1, stop_tag, result_tag, end_tag };
enum class Outcome : std::uint8_t { done, stopped, device_failed, failed };

constexpr std::chrono::milliseconds turn(1), longest_stop(800);

void require(int status, const char* what) {
  if (status != MPI_SUCCESS) throw std::runtime_error(std::string("MPI: ") + what + " failed");
}

// Begins to send. The bytes must live until the request is done, which is never if the rank was lost.
MPI_Request send(int rank, Tag tag, const std::string& bytes) {
  if (bytes.size() > static_cast<std::size_t>(std::numeric_limits<int>::max()))
    throw std::runtime_error("MPI: the genomes of a generation take more than 2 GB; use more ranks or fewer children");
  MPI_Request request;
  require(MPI_Isend(bytes.data(), static_cast<int>(bytes.size()), MPI_BYTE, rank, tag, MPI_COMM_WORLD, &request),
          "sending");
  return request;
}

bool is_sent(MPI_Request& request) {
  int flag = 0;
  require(MPI_Test(&request, &flag, MPI_STATUS_IGNORE), "sending");
  return flag != 0;
}

// Whether a message waits; then `status` describes it.
bool arrived(int rank, int tag, MPI_Status& status) {
  int flag = 0;
  require(MPI_Iprobe(rank, tag, MPI_COMM_WORLD, &flag, &status), "looking for messages");
  return flag != 0;
}

std::string receive(const MPI_Status& status) {
  int size = 0;
  require(MPI_Get_count(&status, MPI_BYTE, &size), "receiving");
  std::string bytes(static_cast<std::size_t>(size), '\0');
  require(MPI_Recv(bytes.data(), size, MPI_BYTE, status.MPI_SOURCE, status.MPI_TAG, MPI_COMM_WORLD, MPI_STATUS_IGNORE),
          "receiving");
  return bytes;
}

// Rank 0's bytes, on all ranks.
std::string broadcast(const std::string& bytes) {
  auto size = static_cast<unsigned long long>(bytes.size());
  require(MPI_Bcast(&size, 1, MPI_UNSIGNED_LONG_LONG, 0, MPI_COMM_WORLD), "sharing the settings");
  std::string shared = bytes;
  shared.resize(size);
  require(MPI_Bcast(shared.data(), static_cast<int>(size), MPI_BYTE, 0, MPI_COMM_WORLD), "sharing the settings");
  return shared;
}

// --- Rank 0

class DistributedAssessor : public Assessor {
 public:
  DistributedAssessor(Assessor& local, int ranks, bool& lost)
      : local_(local), ranks_(static_cast<std::size_t>(ranks)), lost_(lost) {}

  std::optional<std::vector<Assessment>> assess(std::span<const GenomePointer> candidates,
                                                std::span<const double> interim_limits, const Watch& watch) override {
    deal_out(candidates, interim_limits);
    std::vector<Assessment> all(candidates.size());
    std::exception_ptr failure;
    stopped_ = false;
    const auto go_on = [&](std::size_t done) {
      if (!stopped_ && watch && !watch(std::min(done, candidates.size()), candidates.size())) stop();
      return !stopped_;
    };
    try {
      std::vector<GenomePointer> mine;
      for (std::size_t i = 0; i < candidates.size(); i += ranks_) mine.push_back(candidates[i]);
      // The others are expected to be as far.
      const auto own =
          local_.assess(mine, interim_limits, [&](std::size_t done, std::size_t) { return go_on(done * ranks_); });
      if (own) put(all, 0, *own);
    } catch (...) {
      failure = std::current_exception();
      stop();
    }
    collect(all, failure, go_on);
    if (failure) std::rethrow_exception(failure);
    return stopped_ ? std::nullopt : std::optional(std::move(all));
  }

  std::string device_name() const override {
    return local_.device_name().empty() ? "" : local_.device_name() + ", " + std::to_string(ranks_) + " ranks";
  }

 private:
  void deal_out(std::span<const GenomePointer> candidates, std::span<const double> interim_limits) {
    work_.assign(ranks_, {});
    sending_.assign(ranks_, MPI_REQUEST_NULL);
    for (std::size_t rank = 1; rank < ranks_; ++rank) {
      ByteWriter writer;
      writer.numbers(std::vector<double>(interim_limits.begin(), interim_limits.end()));
      writer.count((candidates.size() + ranks_ - 1 - rank) / ranks_);
      for (std::size_t i = rank; i < candidates.size(); i += ranks_) writer.text(candidates[i]->encode());
      work_[rank] = std::move(writer).take();
      sending_[rank] = send(static_cast<int>(rank), work_tag, work_[rank]);
    }
  }

  void stop() {
    stopped_ = true;
    stopped_at_ = std::chrono::steady_clock::now();
    for (std::size_t rank = 1; rank < ranks_; ++rank) {
      MPI_Request request;  // without bytes, so nothing needs to live until it is done
      if (MPI_Isend(nullptr, 0, MPI_BYTE, static_cast<int>(rank), stop_tag, MPI_COMM_WORLD, &request) == MPI_SUCCESS)
        MPI_Request_free(&request);
    }
  }

  // "rank 3 no longer answers"
  static std::string loss(const std::vector<bool>& has_answered) {
    std::string lost;
    int count = 0;
    for (std::size_t rank = 1; rank < has_answered.size(); ++rank)
      if (!has_answered[rank]) lost += (count++ == 0 ? "" : ", ") + std::to_string(rank);
    return (count == 1 ? "rank " : "ranks ") + lost + " no longer " + (count == 1 ? "answers" : "answer") +
           "; the run folder is whole, --resume goes on";
  }

  template <class GoOn>
  void collect(std::vector<Assessment>& all, std::exception_ptr& failure, const GoOn& go_on) {
    std::vector<bool> has_answered(ranks_);
    for (std::size_t missing = ranks_ - 1; missing > 0;) {
      MPI_Status status;
      if (!arrived(MPI_ANY_SOURCE, result_tag, status)) {
        if (!go_on(all.size()) && std::chrono::steady_clock::now() - stopped_at_ > longest_stop) {
          lost_ = true;
          throw std::runtime_error(loss(has_answered));
        }
        std::this_thread::sleep_for(turn);
        continue;
      }
      const std::string bytes = receive(status);
      const auto rank = static_cast<std::size_t>(status.MPI_SOURCE);
      --missing;
      has_answered[rank] = true;
      ByteReader reader(bytes);
      const auto outcome = static_cast<Outcome>(reader.read<std::uint8_t>());
      if (outcome == Outcome::done) put(all, rank, decode_assessments(reader));
      if (outcome != Outcome::device_failed && outcome != Outcome::failed) continue;
      const std::string message = "rank " + std::to_string(rank) + ": " + std::string(reader.text());
      if (!failure)
        failure = outcome == Outcome::device_failed ? std::make_exception_ptr(DeviceError(message))
                                                    : std::make_exception_ptr(std::runtime_error(message));
      if (!stopped_) stop();
    }
    // Who has answered has received the work.
    require(MPI_Waitall(static_cast<int>(ranks_), sending_.data(), MPI_STATUSES_IGNORE), "sending");
  }

  void put(std::vector<Assessment>& all, std::size_t rank, std::vector<Assessment> part) const {
    for (std::size_t k = 0; k < part.size(); ++k) all.at(rank + k * ranks_) = std::move(part[k]);
  }

  Assessor& local_;
  const std::size_t ranks_;
  bool& lost_;
  std::vector<std::string> work_;     // per rank, while it is sent
  std::vector<MPI_Request> sending_;  // per rank
  bool stopped_ = false;
  std::chrono::steady_clock::time_point stopped_at_;
};

// --- The others

struct RankZeroLost {};

// Notices that rank 0 says nothing although all ranks were asked to end.
class Silence {
 public:
  explicit Silence(const std::function<bool()>& interrupted) : interrupted_(interrupted) {}

  // Throws RankZeroLost if it has lasted too long.
  void check() {
    if (heard_ || !interrupted_()) return;
    const auto now = std::chrono::steady_clock::now();
    if (!since_) since_ = now;
    if (now - *since_ > longest_stop) throw RankZeroLost();
  }
  // A message of rank 0 arrived.
  void end() { heard_ = since_.has_value(); }

 private:
  const std::function<bool()>& interrupted_;
  bool heard_ = false;
  std::optional<std::chrono::steady_clock::time_point> since_;
};

std::string answer(Assessor& assessor, const GenomeSpace& space, const std::string& work, Silence& silence) {
  ByteReader reader(work);
  const std::vector<double> limits = reader.numbers<double>();
  std::vector<GenomePointer> genomes(reader.count(sizeof(std::uint32_t)));
  for (GenomePointer& genome : genomes) genome = space.decode(reader.text());
  bool stopped = false;
  const auto assessments = assessor.assess(genomes, limits, [&](std::size_t, std::size_t) {
    MPI_Status status;
    if (!stopped && arrived(0, stop_tag, status)) {
      receive(status);
      silence.end();
      stopped = true;
    }
    silence.check();
    return !stopped;
  });
  ByteWriter writer;
  writer.add(static_cast<std::uint8_t>(assessments ? Outcome::done : Outcome::stopped));
  if (assessments) encode(writer, *assessments);
  return writer.bytes();
}

std::string failed(Outcome outcome, const char* message) {
  ByteWriter writer;
  writer.add(static_cast<std::uint8_t>(outcome));
  writer.text(message);
  return writer.bytes();
}

}  // namespace

struct Ranks::Parts {
  int rank = 0, count = 1, rank_on_host = 0;
  bool lost = false;  // a rank; MPI would wait for it
};

bool Ranks::launched() { return launched_by_mpi(); }
bool Ranks::available() { return true; }

Ranks::Ranks() : parts_(std::make_unique<Parts>()) {
  // Only the thread that made the ranks calls MPI.
  int provided = 0;
  require(MPI_Init_thread(nullptr, nullptr, MPI_THREAD_FUNNELED, &provided), "starting");
  MPI_Comm_set_errhandler(MPI_COMM_WORLD, MPI_ERRORS_RETURN);
  MPI_Comm_rank(MPI_COMM_WORLD, &parts_->rank);
  MPI_Comm_size(MPI_COMM_WORLD, &parts_->count);
  MPI_Comm host;
  require(MPI_Comm_split_type(MPI_COMM_WORLD, MPI_COMM_TYPE_SHARED, parts_->rank, MPI_INFO_NULL, &host), "starting");
  MPI_Comm_rank(host, &parts_->rank_on_host);
  MPI_Comm_free(&host);
}

Ranks::~Ranks() {
  if (parts_->lost) return;
  if (parts_->rank == 0)
    for (int rank = 1; rank < parts_->count; ++rank) MPI_Send(nullptr, 0, MPI_BYTE, rank, end_tag, MPI_COMM_WORLD);
  MPI_Finalize();
}

int Ranks::rank() const { return parts_->rank; }
int Ranks::count() const { return parts_->count; }
int Ranks::rank_on_host() const { return parts_->rank_on_host; }

void Ranks::share(const RunSettings& settings) {
  const RunFileTexts texts = run_file_texts(settings);
  ByteWriter writer;
  writer.text(texts.run);
  writer.count(texts.founders.size());
  for (const std::string& founder : texts.founders) writer.text(founder);
  broadcast(writer.bytes());
}

void Ranks::abandon() { broadcast({}); }

std::optional<RunSettings> Ranks::receive_settings() {
  const std::string bytes = broadcast({});
  if (bytes.empty()) return std::nullopt;
  ByteReader reader(bytes);
  RunFileTexts texts{.run = std::string(reader.text()), .founders = {}};
  texts.founders.resize(reader.count(sizeof(std::uint32_t)));
  for (std::string& founder : texts.founders) founder = reader.text();
  return parse_run_file("settings of rank 0", texts).settings;
}

std::unique_ptr<Assessor> Ranks::distribute(Assessor& local) {
  return std::make_unique<DistributedAssessor>(local, parts_->count, parts_->lost);
}

bool Ranks::serve(const std::function<std::unique_ptr<Assessor>()>& make_assessor, const GenomeSpace& space,
                  const std::function<bool()>& interrupted) try {
  std::unique_ptr<Assessor> assessor;
  Silence silence(interrupted);
  for (;;) {
    MPI_Status status;
    if (!arrived(0, MPI_ANY_TAG, status)) {
      silence.check();
      std::this_thread::sleep_for(turn);
      continue;
    }
    const std::string message = receive(status);
    silence.end();
    if (status.MPI_TAG == end_tag) return true;
    if (status.MPI_TAG != work_tag) continue;  // a `stop` that came after the result
    std::string result;
    try {
      if (!assessor) assessor = make_assessor();
      result = answer(*assessor, space, message, silence);
    } catch (const DeviceError& error) {
      result = failed(Outcome::device_failed, error.what());
    } catch (const std::exception& error) {
      result = failed(Outcome::failed, error.what());
    }
    for (MPI_Request request = send(0, result_tag, result); !is_sent(request); std::this_thread::sleep_for(turn))
      silence.check();
  }
} catch (const RankZeroLost&) {
  parts_->lost = true;
  return false;
}

}  // namespace mercury
