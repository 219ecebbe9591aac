//! The console as a whole, on a terminal made of memory.
