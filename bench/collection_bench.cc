// SPDX-License-Identifier: Apache-2.0
// Measures our kernels and their peers on the same data in the same run, in turn: round 0 of every
// contender, then round 1 and so on. Other load on the machine then disturbs all of them, and
// ratios within a round are meaningful. bench/kernel_table.py makes the table.
//
// Measures the CPU time of one thread. The unit of rays/s is a ray that our kernel accepts: an LF
// pixel with nearest, an element and LF image with bilinear. The number is the same for every
// contender.
//
// Before anything is timed, the contenders' pictures are compared.
#include <benchmark/benchmark.h>

#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <map>
#include <memory>
#include <set>
#include <string>

#include "bench/contender.h"

#include "lf/collection/simd_target.h"
#include "lf/core/check.h"

namespace lf::bench {
namespace {

// Number of LF images for the reference, which is some 50 times slower.
constexpr int kReferenceImages = 1;

struct Entrant {
  std::unique_ptr<Contender> contender;
  int image_count = 0;
  double ray_count = 0;  // number of rays of these images
};

struct Difference {
  double count_share = 0;  // share of rays in other elements
  // The mean difference of elements that both pictures have; 65535 is white.
  double mean_absolute = 0;
  double psnr_db = 0;
};

Difference Compare(const Picture& a, const Picture& b) {
  Difference difference;
  double rays = 0, compared = 0, squares = 0;
  for (size_t i = 0; i < a.sums.size(); ++i) {
    rays += a.counts[i];
    difference.count_share += 0.5 * std::abs(a.counts[i] - b.counts[i]);
    if (a.counts[i] == 0 || b.counts[i] == 0) continue;
    const double apart = a.sums[i] / a.counts[i] - b.sums[i] / b.counts[i];
    difference.mean_absolute += std::abs(apart);
    squares += apart * apart;
    ++compared;
  }
  difference.count_share /= std::max(1.0, rays);
  difference.mean_absolute /= std::max(1.0, compared);
  const double least_square = 1e-12;  // limits the figure for identical pictures
  difference.psnr_db = 10 * std::log10(65535.0 * 65535.0 /
                                       std::max(least_square, squares / std::max(1.0, compared)));
  return difference;
}

// True if there are peers for the case. The loop of the thesis and OpenCV's program undistort LF
// images by moving their pixels, and cannot look an element up in a distorted one.
bool HasPeers(const CaseSpec& spec) {
  return spec.estimator == Estimator::kNearest || spec.distortion.model == DistortionModel::kNone;
}

// True if the case is also measured with OpenCV's bicubic interpolation, which is the peer of
// filters that sharpen.
bool HasCubicPeer(const CaseSpec& spec) {
  return HasPeers(spec) && spec.estimator == Estimator::kBilinear && spec.magnification == 1 &&
         (spec.filter == PixelFilter::kBicubic || spec.filter == PixelFilter::kPrefiltered);
}

// The case that is measured, with the plates of all contenders. Only one arena exists at a time,
// because arenas are large.
class Arena {
 public:
  explicit Arena(const CaseSpec& spec) : case_(MakeCase(spec)) {
    for (const int count :
         std::set<int>{spec.image_count, spec.peer_image_count, kReferenceImages}) {
      const std::unique_ptr<OurKernel> ours = MakeOurKernel(case_);
      ours->Collect(count);
      ray_counts_[count] = static_cast<double>(ours->accepted_count());
      if (count == spec.peer_image_count && HasPeers(spec)) CheckPeers(ours->Develop());
      if (count == kReferenceImages)
        from_reference_ =
            CheckSame("reference", MakeReference(case_), count, ours->Develop(), 0.001, 10);
    }
  }

  const CaseSpec& spec() const { return case_.spec; }
  const Difference& from_reference() const { return from_reference_; }

  Entrant& Enter(const std::string& name) {
    Entrant& entrant = entrants_[name];
    if (entrant.contender) return entrant;
    entrant.image_count = case_.spec.peer_image_count;
    if (name == "thesis") {
      entrant.contender = MakeThesisLoop(case_);
    } else if (name == "thesis_native") {
      entrant.contender = MakeThesisLoopNative(case_);
    } else if (name == "opencv" || name == "opencv_cubic") {
      entrant.contender = MakeOpenCv(case_, name == "opencv_cubic");
    } else if (name == "reference") {
      entrant.contender = MakeReference(case_);
      entrant.image_count = kReferenceImages;
    } else {
      entrant.contender = MakeOurKernel(case_, name == "ours_weighed");
      entrant.image_count = case_.spec.image_count;
    }
    entrant.ray_count = ray_counts_.at(entrant.image_count);
    return entrant;
  }

 private:
  void CheckPeers(const Picture& ours) const {
    const int count = case_.spec.peer_image_count;
    // The limits allow for float positions, which put a few rays into the next element, and for
    // differences of 10^-4 px between the ray model's iteration, arcs and 32-bit ideal positions.
    CheckSame("thesis", MakeThesisLoop(case_), count, ours, 0.002, 60);
    CheckSame("thesis_native", MakeThesisLoopNative(case_), count, ours, 0.002, 60);
    // OpenCV interpolates and demosaics although nearest does not, so the counts of OpenCV differ.
    const bool same_rays = case_.spec.estimator == Estimator::kBilinear;
    CheckSame("opencv", MakeOpenCv(case_), count, ours, same_rays ? 0.002 : 1e9, 300);
    if (HasCubicPeer(case_.spec))
      CheckSame("opencv_cubic", MakeOpenCv(case_, true), count, ours, 0.002, 300);
  }

  Difference CheckSame(const char* name, std::unique_ptr<Contender> peer, int image_count,
                       const Picture& ours, double count_limit, double mean_limit) const {
    peer->Collect(image_count);
    const Difference d = Compare(ours, peer->Develop());
    std::fprintf(stderr, "%s: %s differs by %.1e of the rays, %.1f of 65535 in the mean\n",
                 case_.spec.name.c_str(), name, d.count_share, d.mean_absolute);
    if (d.count_share <= count_limit && d.mean_absolute <= mean_limit) return d;
    std::fprintf(stderr, "not the same picture: limits are %.1e and %.1f\n", count_limit,
                 mean_limit);
    std::exit(EXIT_FAILURE);
  }

  KernelCase case_;
  Difference from_reference_;
  std::map<int, double> ray_counts_;  // by number of LF images
  std::map<std::string, Entrant> entrants_;
};

Arena& ArenaOf(const CaseSpec& spec) {
  static std::unique_ptr<Arena> arena;
  if (arena == nullptr || arena->spec().name != spec.name) {
    arena.reset();
    arena = std::make_unique<Arena>(spec);
  }
  return *arena;
}

void Run(benchmark::State& state, const CaseSpec& spec, const std::string& name) {
  Entrant& entrant = ArenaOf(spec).Enter(name);
  const size_t at = name.find('@');
  LF_CHECK(UseSimdTarget(at == std::string::npos ? "" : name.substr(at + 1)));
  for (auto _ : state) entrant.contender->Collect(entrant.image_count);
  LF_CHECK(UseSimdTarget(""));
  const double rays = entrant.ray_count * static_cast<double>(state.iterations());
  state.counters["rays/s"] = benchmark::Counter(rays, benchmark::Counter::kIsRate);
  if (name != "reference") return;
  state.counters["dB"] = ArenaOf(spec).from_reference().psnr_db;
  state.counters["moved"] = ArenaOf(spec).from_reference().count_share;
}

void Register(int rounds) {
  for (const CaseSpec& spec : AllCases()) {
    std::vector<std::string> names = {"reference", "ours", "ours_weighed"};
    if (HasPeers(spec)) names.insert(names.begin(), {"thesis", "thesis_native", "opencv"});
    if (HasCubicPeer(spec)) names.push_back("opencv_cubic");
    if (spec.every_target)
      for (const std::string& target : SimdTargets()) names.push_back("ours@" + target);
    for (int round = 0; round < rounds; ++round)
      for (const std::string& name : names)
        benchmark::RegisterBenchmark(
            (spec.name + "/" + name + "/round:" + std::to_string(round)).c_str(),
            [spec, name](benchmark::State& state) { Run(state, spec, name); })
            ->Iterations(name.starts_with("ours") ? 3 : 1)
            ->Unit(benchmark::kMillisecond);
  }
}

}  // namespace
}  // namespace lf::bench

// The option --rounds=N precedes Google Benchmark's own options; the default is 5.
int main(int argc, char** argv) {
  int rounds = 5;
  if (argc > 1 && std::strncmp(argv[1], "--rounds=", 9) == 0) {
    rounds = std::atoi(argv[1] + 9);
    argv[1] = argv[0];
    ++argv;
    --argc;
  }
  lf::bench::Register(rounds);
  benchmark::Initialize(&argc, argv);
  if (benchmark::ReportUnrecognizedArguments(argc, argv)) return EXIT_FAILURE;
  benchmark::AddCustomContext("compiler", __VERSION__);
  benchmark::RunSpecifiedBenchmarks();
  return EXIT_SUCCESS;
}
