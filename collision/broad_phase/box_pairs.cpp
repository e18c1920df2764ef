#include "collision/broad_phase/box_pairs.hpp"

#include "collision/in_parts.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

namespace kds::collision {
namespace {

/// The most cells for each box. With more cells fewer boxes are compared, but the cells themselves take time.
constexpr double cells_per_box = 4;

/// Cells are at least this much larger than boxes: more than the roundings of coordinates in cells.
constexpr double room = 1 + 0x1p-20;

/// With more comparisons of a box within its cell than this, on average, the division is refined.
constexpr std::size_t crowd = 4;

/// For so few boxes comparing all with all takes less time than entering them into cells.
constexpr std::size_t small = 256;

}  // namespace

inline bool BoxPairs::overlap(const Rough& a, const Rough& b) { return all_set((a.low <= b.high) & (b.low <= a.high)); }

bool BoxPairs::choose_cells(std::span<const StaticBox> boxes) {
  Eigen::Array3d begin = boxes[0].min;
  Eigen::Array3d end = begin;
  Eigen::Array3d size = boxes[0].max - begin;
  for (const StaticBox& box : boxes) {
    begin = begin.min(box.min);
    end = end.max(box.min);
    size = size.max(box.max - box.min);
  }
  corner_ = begin;
  const Eigen::Array3d span = end - begin;
  double cell = room * size.maxCoeff();
  if (!(span.maxCoeff() < 0x1p1000 && cell < 0x1p1000 && cell > 0x1p-1000)) return false;
  const double most = cells_per_box * static_cast<double>(boxes.size()) + 64;
  for (;; cell *= 1.25) {
    const Eigen::Array3d count = (span / cell).floor() + 1;
    if (count.prod() > most) continue;
    for (std::size_t d = 0; d < 3; ++d) cells_[d] = static_cast<std::size_t>(count[static_cast<Eigen::Index>(d)]);
    break;
  }
  scale_ = 1 / cell;
  return true;
}

/// Counting sort; within a cell in the order of numbers.
bool BoxPairs::sort(std::span<const StaticBox> boxes, std::size_t threads) {
  const std::size_t nx = cells_[0], ny = cells_[1], nz = cells_[2];
  LargeVector<Index> cells(boxes.size());
  const auto whole = [](double x) { return static_cast<std::size_t>(static_cast<std::int64_t>(x)); };
  in_parts(boxes.size(), threads, [&](std::size_t, std::size_t first, std::size_t last) {
    for (std::size_t i = first; i < last; ++i) {
      const Eigen::Array3d at = (boxes[i].min - corner_) * scale_;
      const std::size_t x = std::min(whole(at[0]), nx - 1);
      const std::size_t y = std::min(whole(at[1]), ny - 1);
      const std::size_t z = std::min(whole(at[2]), nz - 1);
      cells[i] = static_cast<Index>((z * ny + y) * nx + x);
    }
  });
  begin_.assign(nx * ny * nz + 1, 0);
  std::size_t comparisons = 0;
  for (const Index cell : cells) comparisons += begin_[cell]++;
  if (comparisons > crowd * boxes.size() && boxes.size() > small) return false;
  Index end = 0;
  for (Index& cell : begin_) cell = end += cell;  // first the ends, which are then counted down to the beginnings
  order_.resize(boxes.size());
  for (std::size_t i = boxes.size(); i-- > 0;) order_[--begin_[cells[i]]] = static_cast<Index>(i);
  cell_.resize(boxes.size());
  rough_.resize(boxes.size());
  const Eigen::Array3d corner = corner_;
  in_parts(boxes.size(), threads, [&](std::size_t, std::size_t first, std::size_t last) {
    for (std::size_t place = first; place < last; ++place) {
      cell_[place] = cells[order_[place]];
      const StaticBox& box = boxes[order_[place]];
      const auto rough = [&](const Eigen::Array3d& end) {
        const auto at = [&](int d) { return static_cast<float>(end[d] - corner[d]); };
        return FourFloats{at(0), at(1), at(2), 0};
      };
      rough_[place].low = rough(box.min);
      rough_[place].high = rough(box.max);
    }
  });
  return true;
}

/// Pairs of which one box is in these rows of cells, the other in the same cell or a later one.
void BoxPairs::search(std::span<const StaticBox> boxes, std::size_t first_row, std::size_t last_row,
                      LargeVector<Pair>& found) const {
  const std::size_t nx = cells_[0], ny = cells_[1], nz = cells_[2];
  const Rough* const rough = rough_.data();  // so that they are not loaded each time
  const Index* const cell = cell_.data();
  for (std::size_t row = first_row; row < last_row; ++row) {
    const std::size_t y = row % ny;
    const bool top = row / ny + 1 == nz;
    // Rows that come later: the next one of this layer, and three of the next layer.
    std::array<const Index*, 4> later;
    std::size_t rows = 0;
    const auto add_row = [&](std::size_t other) { later[rows++] = begin_.data() + other * nx; };
    if (y + 1 < ny) add_row(row + 1);
    if (!top && y > 0) add_row(row + ny - 1);
    if (!top) add_row(row + ny);
    if (!top && y + 1 < ny) add_row(row + ny + 1);
    const Index* const own = begin_.data() + row * nx;
    for (Index i = own[0]; i < own[nx]; ++i) {
      const std::size_t x = cell[i] - row * nx;
      const std::size_t from = x - (x > 0);
      const std::size_t to = std::min(x + 2, nx);
      const Rough box = rough[i];
      const auto compare = [&](Index begin, Index end) {
        for (Index j = begin; j < end; ++j) {
          if (!overlap(box, rough[j])) continue;
          const Index a = order_[i], b = order_[j];
          if (boxes[a].overlaps(boxes[b])) found.push_back({a, b});
        }
      };
      compare(i + 1, own[to]);
      for (std::size_t k = 0; k < rows; ++k) compare(later[k][from], later[k][to]);
    }
  }
}

bool BoxPairs::find(std::span<const StaticBox> boxes, std::size_t threads) {
  pairs_.clear();
  if (boxes.empty() || !choose_cells(boxes)) return false;
  threads = threads_for(boxes.size(), threads);
  if (!sort(boxes, threads)) return false;
  std::vector<LargeVector<Pair>> found(threads);
  in_parts(cells_[1] * cells_[2], threads, [&](std::size_t part, std::size_t first_row, std::size_t last_row) {
    search(boxes, first_row, last_row, found[part]);
  });
  pairs_ = std::move(found[0]);
  for (std::size_t part = 1; part < threads; ++part)
    pairs_.insert(pairs_.end(), found[part].begin(), found[part].end());
  return true;
}

}  // namespace kds::collision
