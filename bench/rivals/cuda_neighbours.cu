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
// or n x 6 floats of 4 bytes (docs/bench-points.md), of which normals are not looked at. --radius
// bounds the distance, for every k one number; without it R is twice the median distance to the
// k-th point, as automatic_radius has it, here by brute force over 256 points. --host runs those
// structures that the libraries build on the host too, to test this program where no GPU is; g++
// takes cudaKDTree's lists there with -fpermissive only.
//
// Each line of the output is a row (docs/bench-points.md), seconds of the queries' kernel by CUDA
// events and of one build, the second, by the host's clock. "wrong" counts those of 256 queries
// where the squared distance to the k-th point or the sum of the squared distances differs from
// brute force in double precision by more than rounding. Photons count into photile's sums with
// their flux; here with the squared distance that is at hand, which favours the rivals. Points are
// in Morton order. Rows of one k run in a child process: where one fails, hangs or crashes the rest
// goes on in the next.
#include <cuda_runtime.h>
#include <sys/mman.h>
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
#include <limits>
#include <memory>
#include <numeric>
#include <random>
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

/// Indices along the Morton curve through the bounding box, 10 bits an axis.
std::vector<std::uint32_t> morton_order(const Points& points) {
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
  return order;
}

Points in_order(const Points& points, const std::vector<std::uint32_t>& order) {
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

template <class List, int k>
__host__ __device__ float2 answer(const List& list) {
  float sum = 0;
  // The fixed list lies in registers, which no loop can index; a heap does not, and an unrolled
  // loop would bring it there.
  constexpr int unrolled = std::is_same_v<List, cukd::FixedCandidateList<k>> ? k : 1;
#pragma unroll unrolled
  for (int i = 0; i < k; ++i) {
    if (list.get_pointID(i) >= 0) sum += list.get_dist2(i);
  }
  return {list.maxRadius2(), sum};
}

/// The sorted list of cuBQL, with the interface of those of cudaKDTree.
template <int k>
struct LinearList {
  cuBQL::knn::Candidate candidates[k];
  cuBQL::knn::Result result;
  __host__ __device__ explicit LinearList(float radius) : result{0, radius * radius} {}
  __host__ __device__ float processCandidate(int id, float squared) {
    // The library's own function takes every point while the list is not full, those beyond R too.
    if (squared < result.sqrDistMax)
      cuBQL::knn::insert_linear(candidates, k, {id, squared}, result);
    return result.sqrDistMax;
  }
  __host__ __device__ float maxRadius2() const { return result.sqrDistMax; }
  __host__ __device__ float get_dist2(int i) const { return candidates[i].sqrDist; }
  __host__ __device__ int get_pointID(int i) const {
    return i < result.numFound ? candidates[i].primID : -1;
  }
};

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

void set_point(float3& data, const float3& point) { data = point; }
void set_point(PointAndAxis& data, const float3& point) { data = {point, 0}; }

enum class Traversal { stack, stack_free, closest_corner };
constexpr const char* traversal_names[] = {"stack", "stack-free", "closest-corner"};

template <class Data, class Traits, class List, int k, Traversal traversal>
struct BalancedSearch {
  const Data* nodes;
  int count;
  cukd::box_t<float3> bounds;
  __host__ __device__ float2 operator()(const float3& query, float radius) const {
    List list(radius);
    if constexpr (traversal == Traversal::stack) {
      cukd::stackBased::knn<List, Data, Traits>(list, query, nodes, count);
    } else if constexpr (traversal == Traversal::stack_free) {
      cukd::stackFree::knn<List, Data, Traits>(list, query, nodes, count);
    } else {
      cukd::cct::knn<List, Data, Traits>(list, query, bounds, nodes, count);
    }
    return answer<List, k>(list);
  }
};

template <class List, int k, Traversal traversal>
struct SpatialSearch {
  cukd::SpatialKDTree<float3> tree;
  __host__ __device__ float2 operator()(const float3& query, float radius) const {
    List list(radius);
    if constexpr (traversal == Traversal::stack) {
      cukd::stackBased::knn<List, float3>(list, tree, query);
    } else {
      cukd::cct::knn<List, float3>(list, tree, query);
    }
    return answer<List, k>(list);
  }
};

template <class Bvh, class List, int k>
struct BvhSearch {
  Bvh bvh;
  const cuBQL::vec3f* points;
  __host__ __device__ float2 operator()(const float3& query, float radius) const {
    List list(radius);
    const cuBQL::vec3f at(query.x, query.y, query.z);
    const cuBQL::vec3f* const all = points;
    const auto visit = [&list, all, at](std::uint32_t id) -> float {
      return list.processCandidate(static_cast<int>(id), cuBQL::fSqrDistance_rd(all[id], at));
    };
    cuBQL::shrinkingRadiusQuery::forEachPrim(visit, bvh, at, radius * radius);
    return answer<List, k>(list);
  }
};

// Structures: built over points in device memory, or in the host's for --host.

struct Cloud {
  const Points& host;
  const float3* device;  ///< null: on the host
  int size() const { return static_cast<int>(host.size()); }
};

template <class Data, class Traits>
class Balanced {
 public:
  explicit Balanced(const Cloud& cloud) : host_(cloud.host.size()) {
    for (std::size_t i = 0; i < host_.size(); ++i) set_point(host_[i], cloud.host[i]);
    if (!cloud.device) return;
    nodes_ = std::make_unique<DeviceArray<Data>>(host_);
    box_ = std::make_unique<DeviceArray<cukd::box_t<float3>>>(1);
  }
  void build() {
    const int count = static_cast<int>(host_.size());
    if (!nodes_) return cukd::buildTree_host<Data, Traits>(host_.data(), count, &bounds_);
    cukd::buildTree<Data, Traits>(nodes_->data(), count, box_->data());
    bounds_ = box_->read()[0];
  }
  template <class List, int k, Traversal traversal>
  BalancedSearch<Data, Traits, List, k, traversal> search() const {
    return {nodes_ ? nodes_->data() : host_.data(), static_cast<int>(host_.size()), bounds_};
  }

 private:
  std::vector<Data> host_;
  std::unique_ptr<DeviceArray<Data>> nodes_;
  std::unique_ptr<DeviceArray<cukd::box_t<float3>>> box_;
  cukd::box_t<float3> bounds_{};
};

class Spatial {
 public:
  Spatial(const Cloud& cloud, int leaf) : cloud_(cloud), leaf_(leaf) {}
  ~Spatial() { release(); }
  void build() {
    release();
    cukd::buildTree(tree, const_cast<float3*>(cloud_.device), cloud_.size(),
                    cukd::BuildConfig{leaf_});
  }
  cukd::SpatialKDTree<float3> tree{};

 private:
  void release() {
    if (tree.nodes) cukd::free(tree);
  }
  const Cloud& cloud_;
  int leaf_;
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

enum class Builder { spatial_median, area, edges, radix };
constexpr const char* builder_names[] = {"spatial median", "surface area", "edge length", "radix"};

template <class Bvh>
class CubqlBvh {
 public:
  CubqlBvh(const Cloud& cloud, Builder builder, int leaf) : cloud_(cloud), builder_(builder) {
    static_assert(sizeof(cuBQL::vec3f) == sizeof(float3));
    config_.makeLeafThreshold = leaf;
    if (builder == Builder::area) config_.enableSAH();
    if (builder == Builder::edges) config_.enableELH();
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
    if constexpr (std::is_same_v<Bvh, cuBQL::bvh3f>) {
      if (builder_ == Builder::radix) {
        cuBQL::cuda::radixBuilder(bvh_, boxes_->data(), count, config_, 0, memory_);
        return;
      }
    }
    cuBQL::gpuBuilder(bvh_, boxes_->data(), count, config_, 0, memory_);
  }
  template <class List, int k>
  BvhSearch<Bvh, List, k> search() const {
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
  const Cloud& cloud_;
  Builder builder_;
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

/// Seconds of `run` on the device: a warm-up, then seven, or fewer where all take longer than three
/// seconds.
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
  CHECK(cudaEventDestroy(start));
  CHECK(cudaEventDestroy(stop));
  std::sort(seconds.begin(), seconds.end());
  return seconds;
}

struct Queries {
  Points host;
  std::vector<std::size_t> checked;  ///< indices of those whose answers brute force knows
  const float3* device = nullptr;
};

struct Workload {
  std::string name;
  Points photons;
  Queries morton, given;                     ///< the same queries in two orders
  std::vector<std::vector<double>> nearest;  ///< of the checked queries
};

struct Measured {
  double build = 0;             ///< seconds
  std::vector<double> seconds;  ///< ascending
  std::size_t wrong = 0;
};

struct Setting {
  const Cloud& cloud;
  const Workload& workload;
  const Queries& queries;
  int k;
  float radius;
  int block;
};

std::size_t count_wrong(const Setting& s, const std::vector<float2>& answers) {
  // A squared distance is a sum of rounded products of rounded differences; a sum of k numbers adds
  // k roundings.
  constexpr double rounding = 1.0 / (1 << 24);
  const double bound = static_cast<double>(s.radius) * s.radius;
  std::size_t wrong = 0;
  for (std::size_t i = 0; i < s.queries.checked.size(); ++i) {
    double sum = 0, last = bound;
    int found = 0;
    for (; found < s.k && s.workload.nearest[i][static_cast<std::size_t>(found)] < bound; ++found) {
      last = s.workload.nearest[i][static_cast<std::size_t>(found)];
      sum += last;
    }
    if (found < s.k) last = bound;
    const float2 got = answers[s.queries.checked[i]];
    if (!(std::abs(got.x - last) <= 8 * rounding * last) ||
        !(std::abs(got.y - sum) <= (s.k + 8) * rounding * sum)) {
      ++wrong;
    }
  }
  return wrong;
}

template <class Structure, class Search>
Measured measure(const Setting& s, Structure& structure, const Search& make_search) {
  Measured measured;
  const int count = static_cast<int>(s.queries.host.size());
  for (int i = 0; i < (s.cloud.device ? 2 : 1); ++i) {  // the first build loads kernels
    const Clock::time_point start = Clock::now();
    structure.build();
    if (s.cloud.device) CHECK(cudaDeviceSynchronize());
    measured.build = seconds_since(start);
    // What a library did not look at: its answers are checked all the same.
    const cudaError_t left = s.cloud.device ? cudaGetLastError() : cudaSuccess;
    if (left != cudaSuccess) std::fprintf(stderr, "(build: %s) ", cudaGetErrorString(left));
  }
  const auto search = make_search();
  if (!s.cloud.device) {
    const Clock::time_point start = Clock::now();
    std::vector<float2> answers;
    for (const float3& query : s.queries.host) answers.push_back(search(query, s.radius));
    measured.seconds = {seconds_since(start)};
    measured.wrong = count_wrong(s, answers);
    return measured;
  }
  const DeviceArray<float2> answers(s.queries.host.size());
  CHECK(cudaMemset(answers.data(), 0xff, s.queries.host.size() * sizeof(float2)));
  measured.seconds = device_seconds([&] {
    answer_queries<<<(count + s.block - 1) / s.block, s.block>>>(search, s.queries.device, count,
                                                                 s.radius, answers.data());
  });
  measured.wrong = count_wrong(s, answers.read());
  return measured;
}

// Rows.

struct Row {
  std::string library, structure, builder, traversal, candidates;
  int leaf = 1;
  bool on_host = false;  ///< whether it runs on the host too
  std::function<Measured(const Setting&)> run;
};

template <class Data, class Traits, class List, int k, Traversal traversal>
Row balanced(const char* structure, const char* candidates) {
  return {"cudaKDTree",
          structure,
          "thrust",
          traversal_names[static_cast<int>(traversal)],
          candidates,
          1,
          true,
          [](const Setting& s) {
            Balanced<Data, Traits> tree(s.cloud);
            return measure(s, tree, [&] { return tree.template search<List, k, traversal>(); });
          }};
}

template <int k, Traversal traversal>
Row spatial(int leaf) {
  return {"cudaKDTree",
          "spatial k-d tree",
          "spatial median",
          traversal_names[static_cast<int>(traversal)],
          "heap",
          leaf,
          false,
          [leaf](const Setting& s) {
            Spatial tree(s.cloud, leaf);
            using Search = SpatialSearch<cukd::HeapCandidateList<k>, k, traversal>;
            return measure(s, tree, [&] { return Search{tree.tree}; });
          }};
}

template <class Bvh, class List, int k>
Row bvh(const char* structure, const char* candidates, Builder builder, int leaf) {
  return {"cuBQL",
          structure,
          builder_names[static_cast<int>(builder)],
          "stack",
          candidates,
          leaf,
          builder == Builder::spatial_median && std::is_same_v<Bvh, cuBQL::bvh3f>,
          [builder, leaf](const Setting& s) {
            CubqlBvh<Bvh> tree(s.cloud, builder, leaf);
            return measure(s, tree, [&] { return tree.template search<List, k>(); });
          }};
}

template <int k>
std::vector<Row> rows_of() {
  using Heap = cukd::HeapCandidateList<k>;
  using Fixed = cukd::FixedCandidateList<k>;
  using Linear = LinearList<k>;
  using Plain = cukd::default_data_traits<float3>;
  using Binary = cuBQL::bvh3f;
  using Wide4 = cuBQL::WideBVH<float, 3, 4>;
  using Wide8 = cuBQL::WideBVH<float, 3, 8>;
  constexpr const char* widest = "balanced k-d tree, widest axis";
  std::vector<Row> rows{
      balanced<PointAndAxis, PointAndAxisTraits, Heap, k, Traversal::closest_corner>(widest,
                                                                                     "heap"),
      balanced<PointAndAxis, PointAndAxisTraits, Heap, k, Traversal::stack>(widest, "heap"),
      balanced<PointAndAxis, PointAndAxisTraits, Heap, k, Traversal::stack_free>(widest, "heap"),
  };
  if constexpr (k <= 64) {
    rows.push_back(
        balanced<PointAndAxis, PointAndAxisTraits, Fixed, k, Traversal::stack>(widest, "fixed"));
  }
  for (const int leaf : {8, 16, 32}) {
    if (k > 200 && leaf == 8) continue;
    rows.push_back(spatial<k, Traversal::closest_corner>(leaf));
    rows.push_back(spatial<k, Traversal::stack>(leaf));
  }
  for (const int leaf : {1, 4, 8, 16, 32, 64}) {
    if (k > 200 && leaf < 16) continue;
    rows.push_back(
        bvh<Binary, Heap, k>("binary BVH", "heap of cudaKDTree", Builder::spatial_median, leaf));
  }
  for (const Builder builder : {Builder::area, Builder::edges, Builder::radix}) {
    if (k > 200) continue;
    rows.push_back(bvh<Binary, Heap, k>("binary BVH", "heap of cudaKDTree", builder, 16));
  }
  for (const int leaf : {8, 16, 32}) {
    if (k > 200 && leaf == 8) continue;
    rows.push_back(
        bvh<Wide4, Heap, k>("wide BVH of 4", "heap of cudaKDTree", Builder::spatial_median, leaf));
    rows.push_back(
        bvh<Wide8, Heap, k>("wide BVH of 8", "heap of cudaKDTree", Builder::spatial_median, leaf));
  }
  if constexpr (k <= 200) {
    rows.push_back(bvh<Binary, Linear, k>("binary BVH", "linear", Builder::spatial_median, 8));
    rows.push_back(balanced<float3, Plain, Heap, k, Traversal::stack>(
        "balanced k-d tree, axes in turns", "heap"));
  }
  return rows;
}

std::vector<Row> rows_of(int k) {
  if (k == 50) return rows_of<50>();
  if (k == 200) return rows_of<200>();
  if (k == 1000) return rows_of<1000>();
  throw std::runtime_error("k is compiled in: 50, 200 or 1000");
}

/// What the child process says to its parent.
struct Progress {
  int row;
  double seconds[256];  ///< of each row that is right, infinite of others
  char message[512];    ///< why the row failed
  char device[256];
};

std::string fields(const Row& row, int block, const char* order, const Workload& workload, int k,
                   float radius, const std::string& device) {
  char text[1024];
  std::snprintf(
      text, sizeof text,
      "\"library\": \"%s\", \"structure\": \"%s\", \"builder\": \"%s\", \"traversal\": \"%s\", "
      "\"candidates\": \"%s\", \"leaf\": %d, \"block\": %d, \"order\": \"%s\", \"workload\": "
      "\"%s\", "
      "\"photons\": %zu, \"queries\": %zu, \"k\": %d, \"radius\": %.9g, \"device\": \"%s\"",
      row.library.c_str(), row.structure.c_str(), row.builder.c_str(), row.traversal.c_str(),
      row.candidates.c_str(), row.leaf, block, order, workload.name.c_str(),
      workload.photons.size(), workload.morton.host.size(), k, radius, device.c_str());
  return text;
}

/// A row and what its name leaves open: all rows in blocks of 128 and Morton order, then the
/// fastest of each library in other blocks and in the order that the queries were given in.
struct Task {
  int row = -1;         ///< -1: the fastest of the library
  const char* library;  ///< null: any
  int block;
  bool morton;
};

std::vector<Task> tasks_of(const std::vector<Row>& rows, bool host) {
  std::vector<Task> tasks;
  for (std::size_t i = 0; i < rows.size(); ++i) {
    if (!host || rows[i].on_host) tasks.push_back({static_cast<int>(i), nullptr, 128, true});
  }
  if (host) return tasks;
  for (const char* library : {"cudaKDTree", "cuBQL"}) {
    for (const int block : {32, 64, 256}) tasks.push_back({-1, library, block, true});
    tasks.push_back({-1, library, 128, false});
  }
  return tasks;
}

const Row& row_of(const Task& task, const std::vector<Row>& rows, const Progress& progress) {
  if (task.row >= 0) return rows[static_cast<std::size_t>(task.row)];
  std::size_t best = rows.size();
  for (std::size_t i = 0; i < rows.size(); ++i) {
    if (rows[i].library != task.library || !std::isfinite(progress.seconds[i])) continue;
    if (best == rows.size() || progress.seconds[i] < progress.seconds[best]) best = i;
  }
  if (best == rows.size()) throw std::runtime_error("no row of the library is right");
  return rows[best];
}

void print_line(const std::string& line) {
  std::fputs((line + "\n").c_str(), stdout);
  std::fflush(stdout);
}

std::string statistics(const std::vector<double>& seconds) {
  char text[256];
  std::snprintf(text, sizeof text,
                "\"seconds\": {\"median\": %.6g, \"min\": %.6g, \"max\": %.6g, \"samples\": %zu}",
                seconds[seconds.size() / 2], seconds.front(), seconds.back(), seconds.size());
  return text;
}

void start_device(Progress& progress) {
  cudaDeviceProp properties;
  CHECK(cudaSetDevice(0));
  CHECK(cudaGetDeviceProperties(&properties, 0));
  std::snprintf(progress.device, sizeof progress.device, "%s", properties.name);
  cudaMemPool_t pool;
  CHECK(cudaDeviceGetDefaultMemPool(&pool, 0));
  std::uint64_t kept =
      std::numeric_limits<std::uint64_t>::max();  // builds are not to wait for the system's memory
  CHECK(cudaMemPoolSetAttribute(pool, cudaMemPoolAttrReleaseThreshold, &kept));
}

/// Runs the tasks from `first` on, in the process that calls it.
void run_tasks(Workload& workload, int k, float radius, bool host, std::size_t first,
               Progress& progress) {
  const std::vector<Row> rows = rows_of(k);
  const std::vector<Task> tasks = tasks_of(rows, host);
  std::unique_ptr<DeviceArray<float3>> photons, morton, given;
  if (!host) {
    start_device(progress);
    photons = std::make_unique<DeviceArray<float3>>(workload.photons);
    morton = std::make_unique<DeviceArray<float3>>(workload.morton.host);
    given = std::make_unique<DeviceArray<float3>>(workload.given.host);
    workload.morton.device = morton->data();
    workload.given.device = given->data();
  }
  const Cloud cloud{workload.photons, host ? nullptr : photons->data()};
  for (std::size_t i = first; i < tasks.size(); ++i) {
    progress.row = static_cast<int>(i);
    const Task& task = tasks[i];
    const Row& row = row_of(task, rows, progress);
    const std::string named = fields(row, task.block, task.morton ? "morton" : "given", workload, k,
                                     radius, host ? "host" : progress.device);
    std::fprintf(stderr, "k %d, %s, %s, %s, %s, %s, leaf %d, block %d%s: ", k, row.library.c_str(),
                 row.structure.c_str(), row.builder.c_str(), row.traversal.c_str(),
                 row.candidates.c_str(), row.leaf, task.block, task.morton ? "" : ", order given");
    const Queries& queries = task.morton ? workload.morton : workload.given;
    const Measured measured = row.run({cloud, workload, queries, k, radius, task.block});
    const double median = measured.seconds[measured.seconds.size() / 2];
    const auto count = static_cast<double>(queries.host.size());
    if (task.row >= 0 && measured.wrong == 0) progress.seconds[task.row] = median;
    char text[256];
    std::snprintf(
        text, sizeof text,
        "\"build\": %.6g, \"ns a query\": %.6g, \"queries per second\": %.6g, \"wrong\": %zu, "
        "\"checked\": %zu",
        measured.build, median / count * 1e9, count / median, measured.wrong,
        queries.checked.size());
    print_line("{" + named + ", " + statistics(measured.seconds) + ", " + text + "}");
    std::fprintf(stderr, "%.3f ms, %zu wrong\n", median * 1e3, measured.wrong);
  }
}

/// Eight independent chains of multiply-adds a thread.
__global__ void multiply_add(float* out, int rounds, float factor) {
  float value[8];
  for (int i = 0; i < 8; ++i) value[i] = static_cast<float>(threadIdx.x + i);
#pragma unroll 32
  for (int round = 0; round < rounds; ++round) {
#pragma unroll
    for (int i = 0; i < 8; ++i) value[i] = fmaf(value[i], factor, 0.5f);
  }
  float sum = 0;
  for (int i = 0; i < 8; ++i) sum += value[i];
  out[threadIdx.x + blockIdx.x * blockDim.x] = sum;
}

__global__ void copy(const float4* from, float4* to, std::size_t count) {
  for (std::size_t i = threadIdx.x + std::size_t{blockIdx.x} * blockDim.x; i < count;
       i += std::size_t{gridDim.x} * blockDim.x) {
    to[i] = from[i];
  }
}

/// What the device does at most, to hold the rows against.
void run_limits(Progress& progress) {
  start_device(progress);
  const std::string device = std::string("\"device\": \"") + progress.device + "\"";
  const std::size_t bytes = std::size_t{1} << 30;
  const DeviceArray<float4> from(bytes / sizeof(float4)), to(bytes / sizeof(float4));
  CHECK(cudaMemset(from.data(), 0, bytes));
  const auto moved = [&](const char* name, const std::vector<double>& seconds) {
    char text[128];
    std::snprintf(text, sizeof text, "\"GB/s\": %.6g",
                  2.0 * static_cast<double>(bytes) / seconds.front() * 1e-9);
    print_line(std::string("{\"structure\": \"") + name + "\", " + device + ", " +
               statistics(seconds) + ", " + text + "}");
  };
  moved("copy by cudaMemcpy, read and written", device_seconds([&] {
          CHECK(cudaMemcpyAsync(to.data(), from.data(), bytes, cudaMemcpyDeviceToDevice));
        }));
  moved("copy by a kernel, read and written", device_seconds([&] {
          copy<<<132 * 16, 512>>>(from.data(), to.data(), bytes / sizeof(float4));
        }));
  const int blocks = 132 * 32, threads = 256, rounds = 16384;
  const DeviceArray<float> out(static_cast<std::size_t>(blocks * threads));
  const std::vector<double> seconds =
      device_seconds([&] { multiply_add<<<blocks, threads>>>(out.data(), rounds, 0.999f); });
  char text[128];
  std::snprintf(text, sizeof text, "\"GFLOP/s\": %.6g",
                16.0 * rounds * blocks * threads / seconds.front() * 1e-9);
  print_line("{\"structure\": \"multiply-add, single precision\", " + device + ", " +
             statistics(seconds) + ", " + text + "}");
}

/// Runs `work` in a child process, which is ended where a row takes longer than `row_limit`
/// seconds. Returns whether it finished; why not is then in the message.
bool run_child(Progress& progress, double row_limit, const std::function<void()>& work) {
  std::fflush(stdout);
  progress.message[0] = 0;
  const pid_t child = fork();
  if (child < 0) throw std::runtime_error("no process can be started");
  if (child == 0) {
    try {
      work();
      std::fflush(nullptr);
      _exit(0);
    } catch (const std::exception& error) {
      std::snprintf(progress.message, sizeof progress.message, "%s", error.what());
    }
    std::fflush(nullptr);
    _exit(1);
  }
  int status = 0, row = progress.row;
  Clock::time_point start = Clock::now();
  while (waitpid(child, &status, WNOHANG) == 0) {
    if (progress.row != row) {
      row = progress.row;
      start = Clock::now();
    }
    if (seconds_since(start) > row_limit) {
      std::snprintf(progress.message, sizeof progress.message, "took longer than %g seconds",
                    row_limit);
      kill(child, SIGKILL);
      waitpid(child, &status, 0);
      return false;
    }
    usleep(10'000);
  }
  if (WIFEXITED(status) && WEXITSTATUS(status) == 0) return true;
  if (!progress.message[0]) {
    std::snprintf(progress.message, sizeof progress.message, "ended by signal %d",
                  WIFSIGNALED(status) ? WTERMSIG(status) : 0);
  }
  return false;
}

std::vector<std::string> split(const std::string& list) {
  std::vector<std::string> parts{""};
  for (const char c : list) {
    if (c == ',') {
      parts.emplace_back();
    } else {
      parts.back() += c;
    }
  }
  return parts;
}

struct Options {
  std::vector<int> k{50, 200};
  std::vector<float> radius;  ///< empty: automatic
  std::string points, queries;
  std::size_t plane_photons = 0, plane_queries = 0;
  double seconds = 55;    ///< none starts later
  double row_limit = 12;  ///< seconds
  bool host = false;
};

Options options_of(int count, char** words) {
  Options options;
  int i = 1;
  const auto next = [&]() -> std::string {
    if (i >= count) throw std::runtime_error(std::string(words[i - 1]) + ": a value is missing");
    return words[i++];
  };
  const auto positive = [](const std::string& text) {
    char* end = nullptr;
    const double number = std::strtod(text.c_str(), &end);
    if (*end || !(number > 0 && number < 1e9))
      throw std::runtime_error(text + ": no positive number");
    return number;
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
    } else if (word == "--row-limit") {
      options.row_limit = positive(next());
    } else if (word == "--host") {
      options.host = true;
    } else if (word == "-k") {
      options.k.clear();
      for (const std::string& k : split(next())) options.k.push_back(static_cast<int>(positive(k)));
    } else if (word == "--radius") {
      for (const std::string& radius : split(next()))
        options.radius.push_back(static_cast<float>(positive(radius)));
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

int run(const Options& options) {
  const Clock::time_point start = Clock::now();
  const bool plane = options.points.empty();
  const Points photons =
      plane ? uniform_points(options.plane_photons, 1) : read_npy(options.points);
  Workload workload;
  workload.name = plane ? "plane" : options.points;
  workload.photons = in_order(photons, morton_order(photons));
  workload.given.host =
      plane ? uniform_points(options.plane_queries, 3) : read_npy(options.queries);
  const std::vector<std::uint32_t> order = morton_order(workload.given.host);
  workload.morton.host = in_order(workload.given.host, order);
  for (const std::size_t i : workload.morton.checked = spread(order.size())) {
    workload.given.checked.push_back(order[i]);
  }
  for (const int k : options.k) rows_of(k);  // throws for other k
  const auto most = static_cast<std::size_t>(*std::max_element(options.k.begin(), options.k.end()));
  if (workload.photons.size() <= most) throw std::runtime_error("no more points than k");
  workload.nearest =
      nearest(workload.photons, picked(workload.morton.host, workload.morton.checked), most);
  std::vector<float> radii = options.radius;
  if (radii.empty()) {
    const auto others = nearest(
        workload.photons, picked(workload.photons, spread(workload.photons.size())), most + 1);
    for (const int k : options.k) {
      std::vector<double> squared;  // the nearest of all is the photon itself
      for (const std::vector<double>& one : others)
        squared.push_back(one[static_cast<std::size_t>(k)]);
      std::nth_element(squared.begin(),
                       squared.begin() + static_cast<std::ptrdiff_t>(squared.size() / 2),
                       squared.end());
      radii.push_back(static_cast<float>(2 * std::sqrt(squared[squared.size() / 2])));
    }
  }
  std::fprintf(stderr, "points and brute force took %.1f s\n", seconds_since(start));

  void* const shared =
      mmap(nullptr, sizeof(Progress), PROT_READ | PROT_WRITE, MAP_SHARED | MAP_ANONYMOUS, -1, 0);
  if (shared == MAP_FAILED) throw std::runtime_error("no shared memory");
  Progress& progress = *static_cast<Progress*>(shared);
  if (!options.host && !run_child(progress, options.row_limit, [&] { run_limits(progress); })) {
    std::fprintf(stderr, "limits of the device: %s\n", progress.message);
  }
  bool failed = false;
  for (std::size_t j = 0; j < options.k.size(); ++j) {
    const int k = options.k[j];
    const std::vector<Row> rows = rows_of(k);
    const std::vector<Task> tasks = tasks_of(rows, options.host);
    std::fill(std::begin(progress.seconds), std::end(progress.seconds),
              std::numeric_limits<double>::infinity());
    for (std::size_t first = 0; first < tasks.size();) {
      if (seconds_since(start) > options.seconds) {
        std::fprintf(stderr, "k %d: %zu rows were not started within %g s\n", k,
                     tasks.size() - first, options.seconds);
        break;
      }
      progress.row = static_cast<int>(first);
      const auto work = [&] { run_tasks(workload, k, radii[j], options.host, first, progress); };
      if (run_child(progress, std::min(options.row_limit, options.seconds), work)) break;
      const auto at = static_cast<std::size_t>(progress.row);
      const Task& task = tasks[at];
      Row unknown;
      unknown.library = task.library ? task.library : "";
      unknown.structure = "the fastest";
      const Row& row = task.row >= 0 ? rows[static_cast<std::size_t>(task.row)] : unknown;
      for (char* c = progress.message; *c; ++c) {
        if (*c == '"' || *c == '\\' || *c == '\n') *c = ' ';
      }
      std::fprintf(stderr, "%s\n", progress.message);
      print_line("{" +
                 fields(row, task.block, task.morton ? "morton" : "given", workload, k, radii[j],
                        progress.device) +
                 ", \"failure\": \"" + progress.message + "\"}");
      failed = true;
      first = at + 1;
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
