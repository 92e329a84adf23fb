// Of <cstddef>, for the compiler of cards at run time.
#pragma once
namespace std {
using size_t = decltype(sizeof(0));
}
