//! The witness sees what it should, and a first few hundred trials.

use super::*;
