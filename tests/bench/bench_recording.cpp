// Recording, replay and a week of data, with real processes on loopback. Prints "name value".
//
//   bench_recording MPM recorder      samples/s that `mpm record` takes without losing one
//   bench_recording MPM replay        samples/s of `mpm replay --rate 0` into one reader
//   bench_recording MPM week ROWS     seconds of `mpm detect` for so many rows of a 10x10 unit
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <cmath>
#include <csignal>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <functional>
#include <iostream>
#include <random>
#include <sstream>
#include <stdexcept>
#include <string>
#include <thread>
#include <vector>

#include "idl/sample_readers.hpp"
#include "idl/unit_publisher.hpp"

namespace mpm {
namespace {

using Clock = std::chrono::steady_clock;

constexpr int kDomain = 7;
constexpr unsigned kLongestRun_s = 900;
constexpr std::chrono::seconds kPatience{20};
constexpr int kSignals = 10;  // of each kind

struct Folder {
  Folder() {
    std::string name = (std::filesystem::temp_directory_path() / "mpm-bench-XXXXXX").string();
    if (mkdtemp(name.data()) == nullptr) throw std::runtime_error("mkdtemp " + name);
    path = name;
  }
  Folder(const Folder&) = delete;
  Folder& operator=(const Folder&) = delete;
  ~Folder() {
    std::error_code ignored;
    std::filesystem::remove_all(path, ignored);
  }
  [[nodiscard]] std::string file(const std::string& name) const { return path + "/" + name; }
  std::string path;
};

/// A program that dies with this one; its errors go to a file.
class Child {
 public:
  Child(const std::vector<std::string>& arguments, const std::string& errors) : pid_(fork()) {
    if (pid_ < 0) throw std::runtime_error("cannot fork");
    if (pid_ > 0) return;
    prctl(PR_SET_PDEATHSIG, SIGKILL);
    if (std::freopen(errors.c_str(), "w", stderr) == nullptr ||
        std::freopen("/dev/null", "w", stdout) == nullptr)
      _exit(2);
    std::vector<char*> argv;
    argv.reserve(arguments.size() + 1);
    for (const std::string& argument : arguments)
      argv.push_back(const_cast<char*>(argument.c_str()));
    argv.push_back(nullptr);
    execv(argv[0], argv.data());
    _exit(2);
  }
  Child(const Child&) = delete;
  Child& operator=(const Child&) = delete;
  ~Child() {
    if (pid_ == 0) return;
    kill(pid_, SIGKILL);
    waitpid(pid_, nullptr, 0);
  }
  void stop() const { kill(pid_, SIGTERM); }
  void wait() {
    int status = 0;
    waitpid(pid_, &status, 0);
    pid_ = 0;
    if (!WIFEXITED(status) || WEXITSTATUS(status) != 0) throw std::runtime_error("mpm failed");
  }

 private:
  pid_t pid_;
};

std::string first_word_before(const std::string& file, const std::string& word) {
  std::ifstream stream(file);
  std::string previous, last, result;
  for (std::string text; stream >> text; previous = text)
    if (text == word) result = previous;
  return result;
}

/// Both sides of one corner of the network.
class Corner {
 public:
  Corner() {
    options_.domain = kDomain;
    options_.partition = "bench-" + std::to_string(getpid()) + "-" + std::to_string(count_++);
  }
  [[nodiscard]] std::vector<std::string> mpm(const std::string& program, const std::string& verb,
                                             std::vector<std::string> more) const {
    std::vector<std::string> arguments = {
        program, verb, "--domain", std::to_string(kDomain), "--partition", options_.partition};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return arguments;
  }
  [[nodiscard]] const idl::DomainOptions& options() const { return options_; }

 private:
  static inline int count_ = 0;
  idl::DomainOptions options_;
};

UnitLayout layout() {
  UnitLayout layout;
  layout.unit = "bench";
  for (const SignalKind kind : {SignalKind::kMv, SignalKind::kCv})
    for (int i = 0; i < kSignals; ++i) layout[kind].tags.push_back("x" + std::to_string(i));
  return layout;
}

Frame frame() {
  Frame frame(SignalCounts{kSignals, 0, kSignals, 0});
  for (const SignalKind kind : {SignalKind::kMv, SignalKind::kCv})
    std::fill(frame[kind].quality.begin(), frame[kind].quality.end(), Quality::kGood);
  return frame;
}

/// Publishes at that rate for some seconds, as a control system that waits for nobody; true if the
/// recorder has every sample. What it could not publish in time does not count for it.
bool records_all(const std::string& program, double rate, double seconds, double& published_rate) {
  const Folder folder;
  const Corner corner;
  Child recorder(corner.mpm(program, "record", {"--output", folder.file("run.mcap")}),
                 folder.file("err"));
  const idl::Participant participant(corner.options());
  const idl::UnitPublisher publisher(participant, layout(), idl::WriterPace::kRealTime);
  if (!publisher.wait_for_readers(kPatience)) throw std::runtime_error("no recorder");
  Frame sample = frame();
  const auto frames = static_cast<std::int64_t>(rate / 2.0 * seconds);
  const Clock::time_point begin = Clock::now();
  for (std::int64_t k = 0; k < frames;) {
    const double elapsed = std::chrono::duration<double>(Clock::now() - begin).count();
    for (const auto due = static_cast<std::int64_t>(elapsed * rate / 2.0); k < due && k < frames;
         ++k) {
      sample.interval = k;
      sample.source_time_ns = k * 1'000'000;
      if (!publisher.publish(sample)) throw std::runtime_error("cannot publish");
    }
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }
  published_rate =
      static_cast<double>(2 * frames) / std::chrono::duration<double>(Clock::now() - begin).count();
  (void)publisher.flush(kPatience);
  recorder.stop();
  recorder.wait();
  const std::string samples = first_word_before(folder.file("err"), "samples");
  constexpr std::int64_t kLayouts = 2;
  return samples == std::to_string(2 * frames + kLayouts) &&
         first_word_before(folder.file("err"), "dropped") == "0";
}

void bench_recorder(const std::string& program) {
  constexpr double kSeconds = 3.0;
  double best = 0.0;
  for (double rate = 10'000.0; rate < 1e6; rate *= std::sqrt(2.0)) {
    double published = 0.0;
    if (!records_all(program, rate, kSeconds, published)) break;
    best = published;
    if (published < 0.9 * rate) break;  // the publisher is at its end, not the recorder
  }
  std::cout << "recorder_samples_per_s " << best << std::endl;
}

void bench_replay(const std::string& program) {
  constexpr int kFrames = 100'000;
  const Folder folder;
  const Corner there, here;
  {
    Child recorder(there.mpm(program, "record", {"--output", folder.file("run.mcap")}),
                   folder.file("err"));
    const idl::Participant participant(there.options());
    const idl::UnitPublisher publisher(participant, layout(), idl::WriterPace::kLossless);
    if (!publisher.wait_for_readers(kPatience)) throw std::runtime_error("no recorder");
    Frame sample = frame();
    for (sample.interval = 0; sample.interval < kFrames; ++sample.interval)
      if (!publisher.publish(sample)) throw std::runtime_error("cannot publish");
    if (!publisher.flush(kPatience)) throw std::runtime_error("the recorder does not take samples");
    recorder.stop();
    recorder.wait();
  }
  const idl::Participant participant(here.options());
  idl::SampleReaders readers(participant);
  idl::WaitSet wait_set;
  readers.attach_to(wait_set);
  Child replay(here.mpm(program, "replay", {folder.file("run.mcap"), "--rate", "0"}),
               folder.file("err"));
  int count = 0;
  Clock::time_point first;
  while (count < 2 * kFrames) {
    if (!wait_set.wait(kPatience)) throw std::runtime_error("the replay lost samples");
    const int before = count;
    readers.take([&](const idl::SampleView&) { ++count; });
    if (before == 0 && count > 0) first = Clock::now();
  }
  const std::chrono::duration<double> seconds = Clock::now() - first;
  replay.wait();
  std::cout << "replay_samples_per_s " << count / seconds.count() << std::endl;
}

/// A unit of 10 MVs and 10 CVs whose every channel exists, and rows of data that its model explains
/// but for noise: set-points of the MVs that move at random.
void write_week(const Folder& folder, std::int64_t rows) {
  std::ofstream unit(folder.file("unit.yaml"));
  unit << "unit: bench\nsample_time: 1\nsignals:\n  mv:\n";
  for (int i = 0; i < kSignals; ++i) unit << "    - {tag: u" << i << "}\n";
  unit << "  cv:\n";
  for (int j = 0; j < kSignals; ++j)
    unit << "    - {tag: y" << j << ", prediction: p" << j << "}\n";
  unit << "model:\n  channels:\n";
  constexpr double kTime_s = 20.0;
  const auto gain = [](int i, int j) { return 0.2 + 0.1 * ((3 * i + 7 * j) % 10); };
  for (int j = 0; j < kSignals; ++j)
    for (int i = 0; i < kSignals; ++i)
      unit << "    - {cv: y" << j << ", mv: u" << i << ", gain: " << gain(i, j)
           << ", time_constants: [" << kTime_s << "]}\n";

  std::ofstream data(folder.file("data.csv"));
  data << "time";
  for (const char* kind : {"u", "y", "p"})
    for (int i = 0; i < kSignals; ++i) data << ',' << kind << i;
  data << '\n';
  std::mt19937_64 random(1);
  std::normal_distribution<double> noise(0.0, 0.1);
  const double pole = std::exp(-1.0 / kTime_s);
  std::vector<double> moves(kSignals, 0.0), outputs(kSignals, 0.0), errors(kSignals, 0.0);
  std::ostringstream row;
  row.precision(7);
  for (std::int64_t k = 0; k < rows; ++k) {
    row.str("");
    row << k;
    for (int i = 0; i < kSignals; ++i) {
      if (random() % 50 == 0) moves[static_cast<std::size_t>(i)] = random() % 2 == 0 ? 1.0 : -1.0;
      row << ',' << moves[static_cast<std::size_t>(i)];
    }
    for (std::size_t j = 0; j < kSignals; ++j) {
      errors[j] = 0.8 * errors[j] + noise(random);
      row << ',' << outputs[j] + errors[j];
    }
    for (std::size_t j = 0; j < kSignals; ++j) row << ',' << outputs[j];
    for (int j = 0; j < kSignals; ++j) {
      double drive = 0.0;
      for (int i = 0; i < kSignals; ++i) drive += gain(i, j) * moves[static_cast<std::size_t>(i)];
      double& output = outputs[static_cast<std::size_t>(j)];
      output = pole * output + (1.0 - pole) * drive;
    }
    data << row.str() << '\n';
  }
}

void bench_week(const std::string& program, std::int64_t rows) {
  const Folder folder;
  write_week(folder, rows);
  const Clock::time_point begin = Clock::now();
  Child(
      {program, "detect", "--config", folder.file("unit.yaml"), "--data", folder.file("data.csv")},
      folder.file("err"))
      .wait();
  const std::chrono::duration<double> seconds = Clock::now() - begin;
  std::cout << "week_seconds " << seconds.count() << std::endl;
}

void run(const std::string& program, const std::string& what, std::int64_t rows) {
  alarm(kLongestRun_s);
  if (what == "recorder") return bench_recorder(program);
  if (what == "replay") return bench_replay(program);
  if (what == "week") return bench_week(program, rows);
  throw std::runtime_error("no such bench: " + what);
}

}  // namespace
}  // namespace mpm

int main(int argc, char** argv) {
  if (argc < 3) {
    std::cerr << "usage: bench_recording MPM recorder | replay | week ROWS\n";
    return 3;
  }
  try {
    mpm::run(argv[1], argv[2], argc > 3 ? std::atoll(argv[3]) : 604'800);
  } catch (const std::exception& error) {
    std::cerr << "bench_recording: " << error.what() << '\n';
    return 2;
  }
}
