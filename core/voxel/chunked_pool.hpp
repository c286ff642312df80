// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cassert>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <vector>

namespace warren {

// Numbered slots of T in chunks that never move, freed slots first in line again. Grows by one
// chunk at a time, so that the heap never holds twice what is used. Copies deeply.
template <typename T, std::size_t kChunkSlots>
class ChunkedPool {
 public:
  ChunkedPool() = default;
  ChunkedPool(ChunkedPool&&) noexcept = default;
  ChunkedPool& operator=(ChunkedPool&&) noexcept = default;
  ChunkedPool& operator=(const ChunkedPool& other) {
    if (this != &other) *this = ChunkedPool(other);
    return *this;
  }
  ChunkedPool(const ChunkedPool& other) : free_(other.free_), size_(other.size_) {
    chunks_.reserve(other.chunks_.size());
    for (const auto& chunk : other.chunks_) chunks_.push_back(std::make_unique<Chunk>(*chunk));
  }
  ~ChunkedPool() = default;

  // A slot whose content is T{}.
  std::uint32_t allocate() {
    if (!free_.empty()) {
      const std::uint32_t index = free_.back();
      free_.pop_back();
      (*this)[index] = T{};
      return index;
    }
    if (size_ == chunks_.size() * kChunkSlots) chunks_.push_back(std::make_unique<Chunk>());
    (*this)[size_++] = T{};
    return size_ - 1;
  }
  void release(std::uint32_t index) { free_.push_back(index); }
  // Forgets all slots, keeps the memory.
  void clear() {
    free_.clear();
    size_ = 0;
  }

  T& operator[](std::uint32_t index) {
    assert(index < size_);
    return chunks_[index / kChunkSlots]->slots[index % kChunkSlots];
  }
  const T& operator[](std::uint32_t index) const {
    assert(index < size_);
    return chunks_[index / kChunkSlots]->slots[index % kChunkSlots];
  }

  std::uint32_t in_use() const { return size_ - static_cast<std::uint32_t>(free_.size()); }
  std::size_t memory_bytes() const {
    return chunks_.size() * sizeof(Chunk) + chunks_.capacity() * sizeof(chunks_[0]) +
           free_.capacity() * sizeof(std::uint32_t);
  }

 private:
  struct Chunk {
    T slots[kChunkSlots]{};
  };
  std::vector<std::unique_ptr<Chunk>> chunks_;
  std::vector<std::uint32_t> free_;
  std::uint32_t size_ = 0;
};

}  // namespace warren
