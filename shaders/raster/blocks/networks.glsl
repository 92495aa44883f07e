// Bitonic networks (Batcher 1968) over registers, written out: indices that compilers do not see as constants
// would put the keys into memory. `up`: ascending.
#ifndef OITLAB_RASTER_NETWORKS_GLSL
#define OITLAB_RASTER_NETWORKS_GLSL

// The includer may define another, of keys of another type.
#ifndef EXCHANGE
#define EXCHANGE(k, i, j, up) \
  { \
    const uint a = k[i], b = k[j]; \
    k[i] = (up) ? min(a, b) : max(a, b); \
    k[j] = (up) ? max(a, b) : min(a, b); \
  }
#endif
#define EXCHANGE_2(k, i, j, up) EXCHANGE(k, i, j, up) EXCHANGE(k, i + 1, j + 1, up)
#define EXCHANGE_4(k, i, j, up) EXCHANGE_2(k, i, j, up) EXCHANGE_2(k, i + 2, j + 2, up)
#define EXCHANGE_8(k, i, j, up) EXCHANGE_4(k, i, j, up) EXCHANGE_4(k, i + 4, j + 4, up)

// Of n keys from i on, whose halves are sorted the one up, the other down.
#define MERGE_1(k, i, up)
#define MERGE_2(k, i, up) EXCHANGE(k, i, i + 1, up)
#define MERGE_4(k, i, up) EXCHANGE_2(k, i, i + 2, up) MERGE_2(k, i, up) MERGE_2(k, i + 2, up)
#define MERGE_8(k, i, up) EXCHANGE_4(k, i, i + 4, up) MERGE_4(k, i, up) MERGE_4(k, i + 4, up)
#define MERGE_16(k, i, up) EXCHANGE_8(k, i, i + 8, up) MERGE_8(k, i, up) MERGE_8(k, i + 8, up)

#define SORT_1(k, i, up)
#define SORT_2(k, i, up) MERGE_2(k, i, up)
#define SORT_4(k, i, up) SORT_2(k, i, true) SORT_2(k, i + 2, false) MERGE_4(k, i, up)
#define SORT_8(k, i, up) SORT_4(k, i, true) SORT_4(k, i + 4, false) MERGE_8(k, i, up)
#define SORT_16(k, i, up) SORT_8(k, i, true) SORT_8(k, i + 8, false) MERGE_16(k, i, up)

// F(i) for i from 0 to n - 1.
#define EACH_1(F) F(0)
#define EACH_2(F) F(0) F(1)
#define EACH_4(F) EACH_2(F) F(2) F(3)
#define EACH_8(F) EACH_4(F) F(4) F(5) F(6) F(7)
#define EACH_16(F) EACH_8(F) F(8) F(9) F(10) F(11) F(12) F(13) F(14) F(15)

// The name that ends with a macro's number: NETWORK(SORT_, N) is SORT_4 where N is 4.
#define NETWORK(name, n) NETWORK_OF(name, n)  // expands n first
#define NETWORK_OF(name, n) name##n

#endif
