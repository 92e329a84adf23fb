// Of <cstdint>, for the compiler of cards at run time: the widths are those of the host (checked
// with the sizes of what is handed over).
#pragma once
namespace std {
using uint8_t = unsigned char;
using uint16_t = unsigned short;
using uint32_t = unsigned int;
using uint64_t = unsigned long long;
} // namespace std
