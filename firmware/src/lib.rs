#![doc = "CM-5 firmware logic."]
#![no_std]
#![forbid(unsafe_code)]
