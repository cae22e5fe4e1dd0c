//! Work that no page waits for gives way to the pages.

/// Does what takes long on half of the processors, behind everything else: a page is drawn
/// meanwhile as if nothing ran.
pub fn aside<T: Send>(work: impl FnOnce() -> T + Send) -> T {
    let all = std::thread::available_parallelism().map_or(1, usize::from);
    let pool = rayon::ThreadPoolBuilder::new()
        .num_threads((all / 2).max(1))
        .start_handler(|_| give_way());
    match pool.build() {
        Ok(pool) => pool.install(work),
        // Without threads of its own it takes those of the others.
        Err(_) => work(),
    }
}

/// Lowers the priority of this thread alone, which Linux can.
fn give_way() {
    #[cfg(target_os = "linux")]
    {
        // Where the system refuses, the work is merely less polite.
        let _ = rustix::process::setpriority_process(None, 10);
    }
}
