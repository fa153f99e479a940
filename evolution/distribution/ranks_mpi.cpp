// SPDX-License-Identifier: Apache-2.0
// Ranks by MPI. All messages are bytes:
//
//   rank 0                          the others
//   work  genomes, limits    ---->
//   stop                     ---->  (of all work so far, if the user interrupts)
//                            <----  result  what became of it, busy time, assessments
//   end                      ---->
//
// Every `work` is answered by one `result`, whatever happens and in their order, so nobody waits for a message that
// does not come. Rank 0 may send the next `work` before the last `result`: then generations overlap on all ranks.
// Waiting looks for messages in turns with short sleeps; MPI would keep a core busy.
//
// If a rank is lost, the launcher asks the others to end, and kills them soon after. Rank 0 then waits for answers only
// as long as ranks need to stop, and the others for a message of rank 0.
#define OMPI_SKIP_MPICXX 1
#include <mpi.h>

#include <algorithm>
#include <chrono>
#include <deque>
#include <limits>
#include <numeric>
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

// Candidates that were dealt out to all ranks, and what came back so far.
struct Deal {
  std::vector<GenomePointer> candidates;
  std::vector<std::string> work;     // per rank, while it is sent
  std::vector<MPI_Request> sending;  // per rank
  std::vector<Assessment> all;       // of the candidates
  std::vector<double> busy_seconds;  // per rank
  std::exception_ptr failure;        // of another rank
  std::size_t missing = 0;           // answers of other ranks
};

class DistributedAssessor : public Assessor {
 public:
  DistributedAssessor(Assessor& local, int ranks, bool& lost)
      : local_(local), ranks_(static_cast<std::size_t>(ranks)), lost_(lost), answered_(ranks_) {}

  void prepare(std::span<const GenomePointer> candidates, std::span<const double> interim_limits) override {
    Deal& deal = deals_.emplace_back();  // a deque does not move its elements, whose bytes are being sent
    deal.candidates.assign(candidates.begin(), candidates.end());
    deal.work.resize(ranks_);
    deal.sending.assign(ranks_, MPI_REQUEST_NULL);
    deal.all.resize(candidates.size());
    for (std::size_t rank = 1; rank < ranks_; ++rank) {
      ByteWriter writer;
      writer.numbers(std::vector<double>(interim_limits.begin(), interim_limits.end()));
      writer.count((candidates.size() + ranks_ - 1 - rank) / ranks_);
      for (std::size_t i = rank; i < candidates.size(); i += ranks_) writer.text(candidates[i]->encode());
      deal.work[rank] = std::move(writer).take();
      deal.sending[rank] = send(static_cast<int>(rank), work_tag, deal.work[rank]);
      ++deal.missing;
    }
    local_.prepare(own(candidates), interim_limits);
  }

  std::optional<std::vector<Assessment>> assess(std::span<const GenomePointer> candidates,
                                                std::span<const double> interim_limits, const Watch& watch) override {
    stopped_at_.reset();  // a previous stop says nothing of what was dealt out since
    if (!deals_.empty() && !std::ranges::equal(deals_.front().candidates, candidates)) {
      forget();
      stopped_at_.reset();
    }
    if (deals_.empty()) prepare(candidates, interim_limits);
    Deal& deal = deals_.front();
    std::exception_ptr failure;
    const auto go_on = [&](std::size_t done) {
      receive_answers();
      if (deal.failure || (watch && !watch(std::min(done, candidates.size()), candidates.size()))) stop();
      return !stopped_at_;
    };
    try {
      // The others are expected to be as far.
      const auto assessments = local_.assess(own(candidates), interim_limits,
                                             [&](std::size_t done, std::size_t) { return go_on(done * ranks_); });
      if (assessments) put(deal, 0, *assessments);
    } catch (...) {
      failure = std::current_exception();
      stop();
    }
    wait_for_answers(deal, [&] { go_on(candidates.size()); });
    if (!failure) failure = deal.failure;
    if (stopped_at_) forget();
    if (failure) std::rethrow_exception(failure);
    if (stopped_at_) return std::nullopt;
    busy_seconds_ = std::accumulate(deal.busy_seconds.begin(), deal.busy_seconds.end(), 0.);
    std::vector<Assessment> all = std::move(deal.all);
    drop_first();
    return all;
  }

  std::string device_name() const override {
    return local_.device_name().empty() ? "" : local_.device_name() + ", " + std::to_string(ranks_) + " ranks";
  }

  double busy_seconds() const override { return (local_.busy_seconds() + busy_seconds_) / static_cast<double>(ranks_); }

 private:
  std::vector<GenomePointer> own(std::span<const GenomePointer> candidates) const {
    std::vector<GenomePointer> mine;
    for (std::size_t i = 0; i < candidates.size(); i += ranks_) mine.push_back(candidates[i]);
    return mine;
  }

  // All that was dealt out.
  void stop() {
    if (stopped_at_) return;
    stopped_at_ = std::chrono::steady_clock::now();
    for (std::size_t rank = 1; rank < ranks_; ++rank) {
      MPI_Request request;  // without bytes, so nothing needs to live until it is done
      if (MPI_Isend(nullptr, 0, MPI_BYTE, static_cast<int>(rank), stop_tag, MPI_COMM_WORLD, &request) == MPI_SUCCESS)
        MPI_Request_free(&request);
    }
  }

  // Waits for the answers to all that was dealt out, and drops them.
  void forget() {
    stop();
    while (!deals_.empty()) {
      wait_for_answers(deals_.front(), [&] { receive_answers(); });
      drop_first();
    }
  }

  void drop_first() {
    // Who has answered has received the work.
    require(MPI_Waitall(static_cast<int>(ranks_), deals_.front().sending.data(), MPI_STATUSES_IGNORE), "sending");
    deals_.pop_front();
    for (std::size_t rank = 1; rank < ranks_; ++rank) --answered_[rank];
  }

  // "rank 3 no longer answers"
  std::string loss() const {
    std::string lost;
    int count = 0;
    for (std::size_t rank = 1; rank < ranks_; ++rank)
      if (answered_[rank] == 0) lost += (count++ == 0 ? "" : ", ") + std::to_string(rank);
    return (count == 1 ? "rank " : "ranks ") + lost + " no longer " + (count == 1 ? "answers" : "answer") +
           "; the run folder is whole, --resume goes on";
  }

  // `look` looks for them.
  template <class Look>
  void wait_for_answers(const Deal& deal, const Look& look) {
    while (true) {
      look();
      if (deal.missing == 0) return;
      if (stopped_at_ && std::chrono::steady_clock::now() - *stopped_at_ > longest_stop) {
        lost_ = true;
        throw std::runtime_error(loss());
      }
      std::this_thread::sleep_for(turn);
    }
  }

  // Those that are there. Each rank answers in the order in which it was dealt to.
  void receive_answers() {
    for (MPI_Status status; arrived(MPI_ANY_SOURCE, result_tag, status);) {
      const std::string bytes = receive(status);
      const auto rank = static_cast<std::size_t>(status.MPI_SOURCE);
      Deal& deal = deals_.at(answered_.at(rank)++);
      --deal.missing;
      ByteReader reader(bytes);
      const auto outcome = static_cast<Outcome>(reader.read<std::uint8_t>());
      if (outcome == Outcome::done) {
        deal.busy_seconds.push_back(reader.read<double>());
        put(deal, rank, decode_assessments(reader));
      }
      if (deal.failure || (outcome != Outcome::device_failed && outcome != Outcome::failed)) continue;
      const std::string message = "rank " + std::to_string(rank) + ": " + std::string(reader.text());
      deal.failure = outcome == Outcome::device_failed ? std::make_exception_ptr(DeviceError(message))
                                                       : std::make_exception_ptr(std::runtime_error(message));
    }
  }

  void put(Deal& deal, std::size_t rank, std::vector<Assessment> part) const {
    for (std::size_t k = 0; k < part.size(); ++k) deal.all.at(rank + k * ranks_) = std::move(part[k]);
  }

  Assessor& local_;
  const std::size_t ranks_;
  bool& lost_;
  std::deque<Deal> deals_;
  std::vector<std::size_t> answered_;  // per rank, how many of the deals
  double busy_seconds_ = 0;            // of the other ranks together
  std::optional<std::chrono::steady_clock::time_point> stopped_at_;
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

// Does what rank 0 sends, in its order. While it tries some candidates, it begins with those that have come since.
class Server {
 public:
  Server(const std::function<std::unique_ptr<Assessor>()>& make_assessor, const GenomeSpace& space,
         const std::function<bool()>& interrupted)
      : make_assessor_(make_assessor), space_(space), silence_(interrupted) {}

  void run() {
    while (true) {
      read_messages();
      if (ended_) return;
      if (jobs_.empty()) {
        wait();
        continue;
      }
      const std::string result = answer();
      jobs_.pop_front();
      for (MPI_Request request = send(0, result_tag, result); !is_sent(request); wait()) read_messages();
    }
  }

 private:
  struct Job {
    std::vector<GenomePointer> candidates;
    std::vector<double> interim_limits;
    bool stopped = false;
    std::exception_ptr failure;
  };

  void wait() {
    silence_.check();
    std::this_thread::sleep_for(turn);
  }

  void read_messages() {
    for (MPI_Status status; !ended_ && arrived(0, MPI_ANY_TAG, status);) {
      const std::string message = receive(status);
      silence_.end();
      if (status.MPI_TAG == end_tag) ended_ = true;
      if (status.MPI_TAG == stop_tag)
        for (Job& job : jobs_) job.stopped = true;
      if (status.MPI_TAG == work_tag) begin(message);
    }
  }

  void begin(const std::string& work) {
    Job& job = jobs_.emplace_back();
    try {
      ByteReader reader(work);
      job.interim_limits = reader.numbers<double>();
      job.candidates.resize(reader.count(sizeof(std::uint32_t)));
      for (GenomePointer& genome : job.candidates) genome = space_.decode(reader.text());
      if (!assessor_) assessor_ = make_assessor_();
      assessor_->prepare(job.candidates, job.interim_limits);
    } catch (...) {
      job.failure = std::current_exception();
    }
  }

  // Of the first job.
  std::string answer() {
    Job& job = jobs_.front();
    ByteWriter writer;
    const auto fail = [&](Outcome outcome, const char* message) {
      writer.add(static_cast<std::uint8_t>(outcome));
      writer.text(message);
    };
    try {
      if (job.failure) std::rethrow_exception(job.failure);
      std::optional<std::vector<Assessment>> assessments;
      if (!job.stopped)
        assessments = assessor_->assess(job.candidates, job.interim_limits, [&](std::size_t, std::size_t) {
          read_messages();
          silence_.check();
          return !job.stopped;
        });
      writer.add(static_cast<std::uint8_t>(assessments ? Outcome::done : Outcome::stopped));
      if (assessments) {
        writer.add(assessor_->busy_seconds());
        encode(writer, *assessments);
      }
    } catch (const DeviceError& error) {
      fail(Outcome::device_failed, error.what());
    } catch (const std::exception& error) {
      fail(Outcome::failed, error.what());
    }
    return std::move(writer).take();
  }

  const std::function<std::unique_ptr<Assessor>()>& make_assessor_;
  const GenomeSpace& space_;
  Silence silence_;
  std::unique_ptr<Assessor> assessor_;
  std::deque<Job> jobs_;
  bool ended_ = false;
};

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
  Server(make_assessor, space, interrupted).run();
  return true;
} catch (const RankZeroLost&) {
  parts_->lost = true;
  return false;
}

}  // namespace mercury
