// The searches of nanoflann_search.cpp by the header that PHOTILE_NANOFLANN names: other names keep
// the two libraries apart in one program.
#define nanoflann nanoflann_of_header
#define nanoflann_of_system nanoflann_given
#define PHOTILE_NANOFLANN_NAME "nanoflann, newer"
#include "support/nanoflann_search.cpp"
