// For LD_PRELOAD: libipopt.so says that it is an older one.
extern "C" void GetIpoptVersion(int* major, int* minor, int* release) {
  *major = 3;
  *minor = 11;
  *release = 9;
}
