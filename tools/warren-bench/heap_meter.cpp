// SPDX-License-Identifier: Apache-2.0
#include "tools/warren-bench/heap_meter.hpp"

#include <algorithm>
#include <cstdlib>
#include <new>

#include <malloc.h>

namespace {

bool g_counting = false;
std::ptrdiff_t g_live = 0;
std::ptrdiff_t g_peak = 0;

}  // namespace

#ifndef WARREN_HEAP_IS_NOT_OURS
namespace {

void* allocate_or_not(std::size_t bytes) noexcept {
  void* const memory = std::malloc(bytes == 0 ? 1 : bytes);
  if (g_counting && memory != nullptr) {
    g_live += static_cast<std::ptrdiff_t>(malloc_usable_size(memory));
    g_peak = std::max(g_peak, g_live);
  }
  return memory;
}

void* allocate(std::size_t bytes) {
  void* const memory = allocate_or_not(bytes);
  if (memory == nullptr) throw std::bad_alloc();
  return memory;
}

void release(void* memory) {
  if (g_counting && memory != nullptr) {
    g_live -= static_cast<std::ptrdiff_t>(malloc_usable_size(memory));
  }
  std::free(memory);
}

}  // namespace

void* operator new(std::size_t bytes) { return allocate(bytes); }
void* operator new[](std::size_t bytes) { return allocate(bytes); }
void* operator new(std::size_t bytes, const std::nothrow_t&) noexcept {
  return allocate_or_not(bytes);
}
void* operator new[](std::size_t bytes, const std::nothrow_t&) noexcept {
  return allocate_or_not(bytes);
}
void operator delete(void* memory) noexcept { release(memory); }
void operator delete[](void* memory) noexcept { release(memory); }
void operator delete(void* memory, std::size_t) noexcept { release(memory); }
void operator delete[](void* memory, std::size_t) noexcept { release(memory); }
#endif

namespace warren {

HeapMeter::HeapMeter() {
  g_live = 0;
  g_peak = 0;
  g_counting = true;
}

HeapMeter::~HeapMeter() { g_counting = false; }

std::size_t HeapMeter::peak_bytes() const { return static_cast<std::size_t>(g_peak); }

}  // namespace warren
