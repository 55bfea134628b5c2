#pragma once
// The function that a fuzz target is: libFuzzer calls it with ever new bytes, replay.cpp with those of files.

#include <cstddef>
#include <cstdint>

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size);
