// Exact searches for the k nearest points by two CUDA libraries, cuBQL and cudaKDTree, on the
// points and queries of photile_bench_knn. Neither library is part of photile: the folders of their
// headers are given here.
//
//   git clone https://github.com/NVIDIA/cuBQL; git clone https://github.com/ingowald/cudaKDTree
//   nvcc -std=c++17 -O3 -arch=sm_90 -DNDEBUG -Xcompiler -fpermissive -IcuBQL -IcudaKDTree
//     bench/rivals/cuda_neighbours.cu -o cuda_neighbours
//   ./cuda_neighbours --plane 1000000 262144 -k 50,200 > rows.jsonl
//   ./cuda_neighbours --points photons.npy --queries hits.npy -k 50,200,1000 --seconds 120
//
// --plane makes the points of the workload "plane" of photile_bench_knn; files are arrays of n x 3
// or n x 6 floats of 4 bytes (docs/kernels/points.md), of which normals are not looked at. --radius
// bounds the distance, for every k one number; without it R is twice the median distance to the
// k-th point, as automatic_radius has it, here by brute force over 256 points. --host runs those
// structures that the libraries build on the host too, to test this program where no GPU is; g++
// takes cudaKDTree's lists there with -fpermissive only.
//
// Each line of the output is a row (docs/kernels/points.md), seconds of the queries' kernel by CUDA
// events and of one build, the second, by the host's clock. "wrong" counts those of 256 queries
// where the squared distance to the k-th point or the sum of the squared distances differs from
// brute force in double precision by more than rounding. Photons count into photile's sums with
// their flux; here with the squared distance that is at hand, which favours the rivals. Points and
// queries are in Morton order.
//
// Variants that were slower on an H200 than one of their kind that is here are left out (all are in
// results/cuda): lists in registers and sorted ones, traversals of the balanced tree with a stack,
// builders by surface area, edge length or radix, splits of x, y and z in turns, wide BVHs of 4,
// and leaves of 1, 4 and 64 points.
//
// Each structure runs in a child process: where one fails, hangs or crashes the rest goes on.
#include <cuda_runtime.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <functional>
#include <iterator>
#include <memory>
#include <numeric>
#include <random>
#include <sstream>
#include <stdexcept>
#include <string>
#include <thread>
#include <type_traits>
#include <vector>

#define CUBQL_GPU_BUILDER_IMPLEMENTATION 1
#include "cuBQL/bvh.h"
#include "cuBQL/queries/common/knn.h"
#include "cuBQL/traversal/shrinkingRadiusQuery.h"
#include "cukd/builder.h"
#include "cukd/knn.h"
#include "cukd/spatial-kdtree.h"

namespace {

using Clock = std::chrono::steady_clock;

double seconds_since(Clock::time_point start) {
  return std::chrono::duration<double>(Clock::now() - start).count();
}

void check(cudaError_t code, const char* what) {
  if (code != cudaSuccess)
    throw std::runtime_error(std::string(what) + ": " + cudaGetErrorString(code));
}
#define CHECK(call) check(call, #call)

/// An array in device memory.
template <class T>
class DeviceArray {
 public:
  explicit DeviceArray(std::size_t size) : size_(size) {
    CHECK(cudaMalloc(&data_, size * sizeof(T)));
  }
  explicit DeviceArray(const std::vector<T>& values) : DeviceArray(values.size()) {
    CHECK(cudaMemcpy(data_, values.data(), size_ * sizeof(T), cudaMemcpyHostToDevice));
  }
  DeviceArray(const DeviceArray&) = delete;
  DeviceArray& operator=(const DeviceArray&) = delete;
  ~DeviceArray() { cudaFree(data_); }
  T* data() const { return data_; }
  std::vector<T> read() const {
    std::vector<T> values(size_);
    CHECK(cudaMemcpy(values.data(), data_, size_ * sizeof(T), cudaMemcpyDeviceToHost));
    return values;
  }

 private:
  std::size_t size_;
  T* data_ = nullptr;
};

// Points.

using Points = std::vector<float3>;

/// Those of photile's workload: the same generator and seeds.
Points uniform_points(std::size_t count, std::uint32_t seed) {
  std::mt19937 generator(seed);
  std::uniform_real_distribution<float> uniform(0, 1);
  Points points(count, float3{0, 0, 0});
  for (float3& point : points) {
    point.x = uniform(generator);
    point.y = uniform(generator);
  }
  return points;
}

/// Errors: runtime_error where the file is no array of n x 3 or n x 6 floats of 4 bytes.
Points read_npy(const std::string& file) {
  std::ifstream stream(file, std::ios::binary);
  const std::string content{std::istreambuf_iterator<char>(stream), {}};
  const auto byte = [&](std::size_t i) {
    return static_cast<std::size_t>(static_cast<unsigned char>(content[i]));
  };
  if (content.size() < 12 || content.compare(1, 5, "NUMPY") != 0)
    throw std::runtime_error(file + ": no NumPy array");
  const std::size_t begin = byte(6) > 1 ? 12 : 10;
  const std::size_t size =
      byte(8) | byte(9) << 8 | (byte(6) > 1 ? byte(10) << 16 | byte(11) << 24 : 0);
  const std::string header = content.substr(begin, size);
  const std::size_t shape = header.find("'shape': (");
  unsigned long long rows = 0, columns = 0;
  if (header.find("'<f4'") == std::string::npos ||
      header.find("'fortran_order': False") == std::string::npos || shape == std::string::npos ||
      std::sscanf(header.c_str() + shape, "'shape': (%llu, %llu", &rows, &columns) != 2 ||
      (columns != 3 && columns != 6) || rows == 0 ||
      content.size() != begin + size + rows * columns * 4) {
    throw std::runtime_error(file + ": no array of n x 3 or n x 6 floats of 4 bytes");
  }
  Points points(rows);
  for (std::size_t i = 0; i < rows; ++i) {
    std::memcpy(&points[i], content.data() + begin + size + i * columns * 4, sizeof(float3));
  }
  return points;
}

/// Along the Morton curve through the bounding box, 10 bits an axis.
Points in_morton_order(const Points& points) {
  float low[3] = {points[0].x, points[0].y, points[0].z}, high[3] = {low[0], low[1], low[2]};
  for (const float3& point : points) {
    const float c[3] = {point.x, point.y, point.z};
    for (int axis = 0; axis < 3; ++axis) {
      low[axis] = std::min(low[axis], c[axis]);
      high[axis] = std::max(high[axis], c[axis]);
    }
  }
  std::vector<std::uint32_t> codes(points.size(), 0), order(points.size());
  for (std::size_t i = 0; i < points.size(); ++i) {
    const float c[3] = {points[i].x, points[i].y, points[i].z};
    for (int axis = 0; axis < 3; ++axis) {
      const auto cell = static_cast<std::uint32_t>(
          (c[axis] - low[axis]) * (1023 / std::max(high[axis] - low[axis], 1e-30f)));
      for (int bit = 0; bit < 10; ++bit) codes[i] |= (cell >> bit & 1u) << (3 * bit + 2 - axis);
    }
  }
  std::iota(order.begin(), order.end(), 0u);
  std::stable_sort(order.begin(), order.end(),
                   [&](std::uint32_t a, std::uint32_t b) { return codes[a] < codes[b]; });
  Points sorted;
  for (const std::uint32_t i : order) sorted.push_back(points[i]);
  return sorted;
}

/// Squared distances, ascending, from each of the queries to the nearest `count` points, by brute
/// force.
std::vector<std::vector<double>> nearest(const Points& points, const Points& queries,
                                         std::size_t count) {
  std::vector<std::vector<double>> found(queries.size());
  const unsigned workers = std::max(1u, std::thread::hardware_concurrency());
  std::vector<std::thread> threads;
  for (unsigned worker = 0; worker < workers; ++worker) {
    threads.emplace_back([&, worker] {
      std::vector<double> squared(points.size());
      for (std::size_t q = worker; q < queries.size(); q += workers) {
        for (std::size_t i = 0; i < points.size(); ++i) {
          const double x = static_cast<double>(points[i].x) - queries[q].x;
          const double y = static_cast<double>(points[i].y) - queries[q].y;
          const double z = static_cast<double>(points[i].z) - queries[q].z;
          squared[i] = x * x + y * y + z * z;
        }
        const auto last =
            squared.begin() + static_cast<std::ptrdiff_t>(std::min(count, squared.size()));
        std::nth_element(squared.begin(), last - 1, squared.end());
        std::sort(squared.begin(), last);
        found[q].assign(squared.begin(), last);
      }
    });
  }
  for (std::thread& thread : threads) thread.join();
  return found;
}

// Searches: each answers a query with the squared distance to the k-th point, or R squared where
// fewer lie within R, and the sum of the squared distances.

template <int k>
__host__ __device__ float2 answer(const cukd::HeapCandidateList<k>& list) {
  float sum = 0;
  // A heap lies in memory: an unrolled loop would bring it into registers.
#pragma unroll 1
  for (int i = 0; i < k; ++i) {
    if (list.get_pointID(i) >= 0) sum += list.get_dist2(i);
  }
  return {list.maxRadius2(), sum};
}

/// A point that stores the axis of its split: without it cudaKDTree splits x, y and z in turns,
/// also where the points lie on a plane.
struct alignas(16) PointAndAxis {
  float3 point;
  int axis;
};

struct PointAndAxisTraits : cukd::default_data_traits<float3> {
  enum { has_explicit_dim = true };
  using data_t = PointAndAxis;
  static inline __host__ __device__ const float3& get_point(const PointAndAxis& p) {
    return p.point;
  }
  static inline __host__ __device__ float get_coord(const PointAndAxis& p, int d) {
    return cukd::get_coord(p.point, d);
  }
  static inline __host__ __device__ int get_dim(const PointAndAxis& p) { return p.axis; }
  static inline __host__ __device__ void set_dim(PointAndAxis& p, int axis) { p.axis = axis; }
};

template <int k>
struct BalancedSearch {
  const PointAndAxis* nodes;
  int count;
  __host__ __device__ float2 operator()(const float3& query, float radius) const {
    using List = cukd::HeapCandidateList<k>;
    List list(radius);
    cukd::stackFree::knn<List, PointAndAxis, PointAndAxisTraits>(list, query, nodes, count);
    return answer<k>(list);
  }
};

template <int k, bool closest_corner>
struct SpatialSearch {
  cukd::SpatialKDTree<float3> tree;
  __host__ __device__ float2 operator()(const float3& query, float radius) const {
    using List = cukd::HeapCandidateList<k>;
    List list(radius);
    if constexpr (closest_corner) {
      cukd::cct::knn<List, float3>(list, tree, query);
    } else {
      cukd::stackBased::knn<List, float3>(list, tree, query);
    }
    return answer<k>(list);
  }
};

template <class Bvh, int k>
struct BvhSearch {
  Bvh bvh;
  const cuBQL::vec3f* points;
  __host__ __device__ float2 operator()(const float3& query, float radius) const {
    cukd::HeapCandidateList<k> list(radius);
    const cuBQL::vec3f at(query.x, query.y, query.z);
    const cuBQL::vec3f* const all = points;
    const auto visit = [&list, all, at](std::uint32_t id) -> float {
      return list.processCandidate(static_cast<int>(id), cuBQL::fSqrDistance_rd(all[id], at));
    };
    cuBQL::shrinkingRadiusQuery::forEachPrim(visit, bvh, at, radius * radius);
    return answer<k>(list);
  }
};

// Structures: built over points in device memory, or in the host's for --host.

struct Cloud {
  const Points& host;
  const float3* device;  ///< null: on the host
  int size() const { return static_cast<int>(host.size()); }
};

class Balanced {
 public:
  Balanced(const Cloud& cloud, int) {
    for (const float3& point : cloud.host) host_.push_back({point, 0});
    if (!cloud.device) return;
    nodes_ = std::make_unique<DeviceArray<PointAndAxis>>(host_);
    bounds_ = std::make_unique<DeviceArray<cukd::box_t<float3>>>(1);
  }
  void build() {
    using Traits = PointAndAxisTraits;
    const int count = static_cast<int>(host_.size());
    if (nodes_) {
      return cukd::buildTree<PointAndAxis, Traits>(nodes_->data(), count, bounds_->data());
    }
    cukd::box_t<float3> bounds;
    cukd::buildTree_host<PointAndAxis, Traits>(host_.data(), count, &bounds);
  }
  template <int k>
  BalancedSearch<k> search() const {
    return {nodes_ ? nodes_->data() : host_.data(), static_cast<int>(host_.size())};
  }

 private:
  std::vector<PointAndAxis> host_;
  std::unique_ptr<DeviceArray<PointAndAxis>> nodes_;
  std::unique_ptr<DeviceArray<cukd::box_t<float3>>> bounds_;  ///< that the builder asks for
};

template <bool closest_corner>
class Spatial {
 public:
  Spatial(const Cloud& cloud, int leaf) : cloud_(cloud), leaf_(leaf) {}
  ~Spatial() { release(); }
  void build() {
    release();
    cukd::buildTree(tree_, const_cast<float3*>(cloud_.device), cloud_.size(),
                    cukd::BuildConfig{leaf_});
  }
  template <int k>
  SpatialSearch<k, closest_corner> search() const {
    return {tree_};
  }

 private:
  void release() {
    if (tree_.nodes) cukd::free(tree_);
  }
  Cloud cloud_;
  int leaf_;
  cukd::SpatialKDTree<float3> tree_{};
};

/// Memory of the device's pool. That of cuBQL itself would free null pointers, which its wide
/// builder passes.
struct PoolMemory final : cuBQL::GpuMemoryResource {
  void malloc(void** pointer, size_t size, cudaStream_t stream) override {
    CHECK(cudaMallocAsync(pointer, size, stream));
  }
  void free(void* pointer, cudaStream_t stream) override {
    if (pointer) CHECK(cudaFreeAsync(pointer, stream));
  }
};

__global__ void make_boxes(const cuBQL::vec3f* points, int count, cuBQL::box3f* boxes) {
  const int i = static_cast<int>(threadIdx.x + blockIdx.x * blockDim.x);
  if (i < count) boxes[i] = cuBQL::box3f().including(points[i]);
}

template <class Bvh>
class CubqlBvh {
 public:
  CubqlBvh(const Cloud& cloud, int leaf) : cloud_(cloud) {
    static_assert(sizeof(cuBQL::vec3f) == sizeof(float3));
    config_.makeLeafThreshold = leaf;
    if (cloud.device) boxes_ = std::make_unique<DeviceArray<cuBQL::box3f>>(cloud.host.size());
  }
  ~CubqlBvh() { release(); }
  void build() {
    release();
    const auto count = static_cast<std::uint32_t>(cloud_.size());
    if (!cloud_.device) {
      std::vector<cuBQL::box3f> boxes(count);
      for (std::uint32_t i = 0; i < count; ++i) boxes[i] = cuBQL::box3f().including(points()[i]);
      cuBQL::cpuBuilder(bvh_, boxes.data(), count, config_);
      return;
    }
    make_boxes<<<(count + 255) / 256, 256>>>(points(), cloud_.size(), boxes_->data());
    CHECK(cudaGetLastError());
    cuBQL::gpuBuilder(bvh_, boxes_->data(), count, config_, 0, memory_);
  }
  template <int k>
  BvhSearch<Bvh, k> search() const {
    return {bvh_, points()};
  }

 private:
  const cuBQL::vec3f* points() const {
    return reinterpret_cast<const cuBQL::vec3f*>(cloud_.device ? cloud_.device
                                                               : cloud_.host.data());
  }
  void release() {
    if (!bvh_.nodes) return;
    if (cloud_.device) {
      cuBQL::cuda::free(bvh_, 0, memory_);
    } else {
      cuBQL::cpu::freeBVH(bvh_);
    }
  }
  Cloud cloud_;
  cuBQL::BuildConfig config_;
  PoolMemory memory_;
  std::unique_ptr<DeviceArray<cuBQL::box3f>> boxes_;
  Bvh bvh_;
};

// Measurements.

template <class Search>
__global__ void answer_queries(Search search, const float3* queries, int count, float radius,
                               float2* answers) {
  const int i = static_cast<int>(threadIdx.x + blockIdx.x * blockDim.x);
  if (i < count) answers[i] = search(queries[i], radius);
}

/// Seconds of `run` on the device, ascending: a warm-up, then seven, or fewer where all take longer
/// than three seconds.
std::vector<double> device_seconds(const std::function<void()>& run) {
  cudaEvent_t start, stop;
  CHECK(cudaEventCreate(&start));
  CHECK(cudaEventCreate(&stop));
  std::vector<double> seconds;
  double spent = 0;
  for (int i = 0; i < 8 && (i < 2 || spent < 3); ++i) {
    CHECK(cudaEventRecord(start));
    run();
    CHECK(cudaGetLastError());
    CHECK(cudaEventRecord(stop));
    CHECK(cudaEventSynchronize(stop));
    float milliseconds = 0;
    CHECK(cudaEventElapsedTime(&milliseconds, start, stop));
    spent += milliseconds * 1e-3;
    if (i > 0) seconds.push_back(milliseconds * 1e-3);
  }
  std::sort(seconds.begin(), seconds.end());
  return seconds;
}

struct Workload {
  std::string name;
  Points photons, queries;
  std::vector<std::size_t> checked;          ///< queries whose answers brute force knows
  std::vector<std::vector<double>> nearest;  ///< squared distances of these
  int k;
  float radius;
};

std::size_t count_wrong(const Workload& work, const std::vector<float2>& answers) {
  // A squared distance is a sum of rounded products of rounded differences; a sum of k numbers adds
  // k roundings.
  constexpr double rounding = 1.0 / (1 << 24);
  const double bound = static_cast<double>(work.radius) * work.radius;
  std::size_t wrong = 0;
  for (std::size_t i = 0; i < work.checked.size(); ++i) {
    const std::vector<double>& nearest = work.nearest[i];
    double sum = 0, last = bound;
    int found = 0;
    for (; found < work.k && nearest[static_cast<std::size_t>(found)] < bound; ++found) {
      last = nearest[static_cast<std::size_t>(found)];
      sum += last;
    }
    if (found < work.k) last = bound;
    const float2 got = answers[work.checked[i]];
    if (!(std::abs(got.x - last) <= 8 * rounding * last) ||
        !(std::abs(got.y - sum) <= (work.k + 8) * rounding * sum)) {
      ++wrong;
    }
  }
  return wrong;
}

/// What is measured: each in blocks of 32 and of 128 queries.
struct Row {
  const char *library, *structure, *builder, *traversal, *candidates;
  int leaf;
  bool on_host;  ///< whether it runs on the host too
  void (*run)(const Row& row, const Workload& work, bool host);

  /// The line of a row, but for what was found.
  void print_head(const Workload& work, int block, const std::string& device) const {
    std::printf(R"({"library": "%s", "structure": "%s", "builder": "%s", "traversal": "%s", )",
                library, structure, builder, traversal);
    std::printf(R"("candidates": "%s", "leaf": %d, "block": %d, "order": "morton", )", candidates,
                leaf, block);
    std::printf(R"("workload": "%s", "photons": %zu, "queries": %zu, )", work.name.c_str(),
                work.photons.size(), work.queries.size());
    std::printf(R"("k": %d, "radius": %.9g, "device": "%s", )", work.k, work.radius,
                device.c_str());
  }
};

/// What was found: seconds ascending.
void print_measured(const Workload& work, double build, const std::vector<double>& seconds,
                    const std::vector<float2>& answers) {
  const double median = seconds[seconds.size() / 2];
  const auto count = static_cast<double>(work.queries.size());
  std::printf(R"("seconds": {"median": %.6g, "min": %.6g, "max": %.6g, "samples": %zu}, )", median,
              seconds.front(), seconds.back(), seconds.size());
  std::printf(R"("build": %.6g, "ns a query": %.6g, "queries per second": %.6g, )", build,
              median / count * 1e9, count / median);
  std::printf(R"("wrong": %zu, "checked": %zu})"
              "\n",
              count_wrong(work, answers), work.checked.size());
  std::fflush(stdout);
}

/// The device's name. Builds are not to wait for the system's memory.
std::string start_device() {
  cudaDeviceProp properties;
  CHECK(cudaSetDevice(0));
  CHECK(cudaGetDeviceProperties(&properties, 0));
  cudaMemPool_t pool;
  CHECK(cudaDeviceGetDefaultMemPool(&pool, 0));
  std::uint64_t kept = UINT64_MAX;
  CHECK(cudaMemPoolSetAttribute(pool, cudaMemPoolAttrReleaseThreshold, &kept));
  return properties.name;
}

template <class Structure, int k>
void measure(const Row& row, const Workload& work, bool host) {
  const std::string device = host ? "host" : start_device();
  std::unique_ptr<DeviceArray<float3>> photons;
  if (!host) photons = std::make_unique<DeviceArray<float3>>(work.photons);
  Structure structure({work.photons, host ? nullptr : photons->data()}, row.leaf);
  double build = 0;
  for (int i = 0; i < (host ? 1 : 2); ++i) {  // the first build loads kernels
    const Clock::time_point start = Clock::now();
    structure.build();
    if (!host) CHECK(cudaDeviceSynchronize());
    build = seconds_since(start);
  }
  // What a library did not look at: its answers are checked all the same.
  const cudaError_t left = host ? cudaSuccess : cudaGetLastError();
  if (left != cudaSuccess) std::fprintf(stderr, "build: %s\n", cudaGetErrorString(left));
  const auto search = structure.template search<k>();
  if (host) {
    const Clock::time_point start = Clock::now();
    std::vector<float2> answers;
    for (const float3& query : work.queries) answers.push_back(search(query, work.radius));
    row.print_head(work, 1, device);
    return print_measured(work, build, {seconds_since(start)}, answers);
  }
  const int count = static_cast<int>(work.queries.size());
  const DeviceArray<float3> queries(work.queries);
  const DeviceArray<float2> answers(work.queries.size());
  for (const int block : {32, 128}) {
    CHECK(cudaMemset(answers.data(), 0xff, work.queries.size() * sizeof(float2)));
    const std::vector<double> seconds = device_seconds([&] {
      answer_queries<<<(count + block - 1) / block, block>>>(search, queries.data(), count,
                                                             work.radius, answers.data());
    });
    const std::vector<float2> found = answers.read();
    row.print_head(work, block, device);
    print_measured(work, build, seconds, found);
  }
}

template <int k>
std::vector<Row> rows_of() {
  using Wide = cuBQL::WideBVH<float, 3, 8>;
  std::vector<Row> rows{{"cudaKDTree", "balanced k-d tree, widest axis", "thrust", "stack-free",
                         "heap", 1, true, measure<Balanced, k>}};
  for (const int leaf : {8, 16, 32}) {
    const auto spatial = [&](const char* traversal, auto run) {
      rows.push_back({"cudaKDTree", "spatial k-d tree", "spatial median", traversal, "heap", leaf,
                      false, run});
    };
    const auto bvh = [&](const char* structure, bool on_host, auto run) {
      rows.push_back({"cuBQL", structure, "spatial median", "stack", "heap of cudaKDTree", leaf,
                      on_host, run});
    };
    spatial("closest-corner", measure<Spatial<true>, k>);
    spatial("stack", measure<Spatial<false>, k>);
    bvh("binary BVH", true, measure<CubqlBvh<cuBQL::bvh3f>, k>);
    bvh("wide BVH of 8", false, measure<CubqlBvh<Wide>, k>);
  }
  return rows;
}

std::vector<Row> rows_of(int k) {
  if (k == 50) return rows_of<50>();
  if (k == 200) return rows_of<200>();
  if (k == 1000) return rows_of<1000>();
  throw std::runtime_error("k is compiled in: 50, 200 or 1000");
}

/// Runs a row in a child process, which is ended after some seconds. Returns whether it finished;
/// if not its line says why.
bool finishes(const Row& row, const Workload& work, bool host) {
  constexpr unsigned most_seconds = 30;
  const auto fail = [&](const std::string& problem) {
    row.print_head(work, 32, "");
    std::printf(R"("failure": "%s"})"
                "\n",
                problem.c_str());
    std::fflush(stdout);
    return false;
  };
  std::fflush(stdout);
  const pid_t child = fork();
  if (child < 0) throw std::runtime_error("no process can be started");
  if (child == 0) {
    alarm(most_seconds);
    try {
      row.run(row, work, host);
      _exit(0);
    } catch (const std::exception& error) {
      fail(error.what());
    }
    _exit(1);
  }
  int status = 0;
  waitpid(child, &status, 0);
  if (!WIFSIGNALED(status)) return WEXITSTATUS(status) == 0;
  const int signal = WTERMSIG(status);
  if (signal == SIGALRM)
    return fail("took longer than " + std::to_string(most_seconds) + " seconds");
  return fail("ended by signal " + std::to_string(signal));
}

struct Options {
  std::vector<int> k{50, 200};
  std::vector<float> radius;  ///< empty: automatic
  std::string points, queries;
  std::size_t plane_photons = 0, plane_queries = 0;
  double seconds = 55;  ///< none starts later
  bool host = false;
};

Options options_of(int count, char** words) {
  Options options;
  int i = 1;
  const auto next = [&]() -> std::string {
    if (i >= count) throw std::runtime_error(std::string(words[i - 1]) + ": a value is missing");
    return words[i++];
  };
  const auto positive = [](const std::string& word) {
    char* end = nullptr;
    const double number = std::strtod(word.c_str(), &end);
    if (*end || !(number > 0 && number < 1e9))
      throw std::runtime_error(word + ": no positive number");
    return number;
  };
  const auto list = [&](auto& numbers) {
    numbers.clear();
    std::istringstream words_of_list(next());
    for (std::string word; std::getline(words_of_list, word, ',');) {
      numbers.push_back(static_cast<std::decay_t<decltype(numbers[0])>>(positive(word)));
    }
  };
  while (i < count) {
    const std::string word = next();
    if (word == "--plane") {
      options.plane_photons = static_cast<std::size_t>(positive(next()));
      options.plane_queries = static_cast<std::size_t>(positive(next()));
    } else if (word == "--points") {
      options.points = next();
    } else if (word == "--queries") {
      options.queries = next();
    } else if (word == "--seconds") {
      options.seconds = positive(next());
    } else if (word == "--host") {
      options.host = true;
    } else if (word == "-k") {
      list(options.k);
    } else if (word == "--radius") {
      list(options.radius);
    } else {
      throw std::runtime_error(word +
                               ": no option; see the head of bench/rivals/cuda_neighbours.cu");
    }
  }
  if (options.points.empty() != options.queries.empty())
    throw std::runtime_error("--points needs --queries");
  if (options.points.empty() && (options.plane_photons == 0 || options.plane_queries == 0)) {
    throw std::runtime_error("give --plane PHOTONS QUERIES, or --points and --queries");
  }
  if (!options.radius.empty() && options.radius.size() != options.k.size()) {
    throw std::runtime_error("--radius: one number for every k");
  }
  return options;
}

/// At most 256 of the numbers below `count`, evenly spread.
std::vector<std::size_t> spread(std::size_t count) {
  const std::size_t taken = std::min<std::size_t>(count, 256);
  std::vector<std::size_t> indices;
  for (std::size_t i = 0; i < taken; ++i) indices.push_back(i * count / taken);
  return indices;
}

Points picked(const Points& points, const std::vector<std::size_t>& indices) {
  Points result;
  for (const std::size_t i : indices) result.push_back(points[i]);
  return result;
}

/// Twice the median distance to the k-th point.
///   others   squared distances from points to those around, the first of which is the point itself
float automatic_radius(const std::vector<std::vector<double>>& others, int k) {
  std::vector<double> squared;
  for (const auto& one : others) squared.push_back(one[static_cast<std::size_t>(k)]);
  std::sort(squared.begin(), squared.end());
  return static_cast<float>(2 * std::sqrt(squared[squared.size() / 2]));
}

int run(const Options& options) {
  const Clock::time_point start = Clock::now();
  const bool plane = options.points.empty();
  Workload work;
  work.name = plane ? "plane" : options.points;
  work.photons =
      in_morton_order(plane ? uniform_points(options.plane_photons, 1) : read_npy(options.points));
  work.queries =
      in_morton_order(plane ? uniform_points(options.plane_queries, 3) : read_npy(options.queries));
  work.checked = spread(work.queries.size());
  for (const int k : options.k) rows_of(k);  // throws for other k
  const auto most = static_cast<std::size_t>(*std::max_element(options.k.begin(), options.k.end()));
  if (work.photons.size() <= most) throw std::runtime_error("no more points than k");
  work.nearest = nearest(work.photons, picked(work.queries, work.checked), most);
  std::vector<std::vector<double>> others;
  if (options.radius.empty()) {
    others = nearest(work.photons, picked(work.photons, spread(work.photons.size())), most + 1);
  }
  std::fprintf(stderr, "points and brute force took %.1f s\n", seconds_since(start));

  bool failed = false;
  for (std::size_t j = 0; j < options.k.size(); ++j) {
    work.k = options.k[j];
    work.radius = others.empty() ? options.radius[j] : automatic_radius(others, work.k);
    for (const Row& row : rows_of(work.k)) {
      if (options.host && !row.on_host) continue;
      std::fprintf(stderr, "k %d, %s, %s, %s, leaf %d\n", work.k, row.library, row.structure,
                   row.traversal, row.leaf);
      if (seconds_since(start) > options.seconds) {
        std::fprintf(stderr, "and the rows behind it were not started within %g s\n",
                     options.seconds);
        break;
      }
      failed |= !finishes(row, work, options.host);
    }
  }
  std::fprintf(stderr, "all took %.1f s\n", seconds_since(start));
  return failed ? 1 : 0;
}

}  // namespace

int main(int count, char** words) {
  try {
    return run(options_of(count, words));
  } catch (const std::exception& error) {
    std::fprintf(stderr, "cuda_neighbours: %s\n", error.what());
    return 2;
  }
}
