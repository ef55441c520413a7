#![no_main]

#[path = "../../picture.rs"]
mod picture;
#[path = "../../ppm.rs"]
mod target;

libfuzzer_sys::fuzz_target!(|bytes: &[u8]| target::run(bytes));
