//! The `fragscale` command: see [`fragscale::cli`].

fn main() -> std::process::ExitCode {
    fragscale::cli::run()
}
