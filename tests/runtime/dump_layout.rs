// Writes what layout.rs of examples/bevy makes of a package: its arrays, and its block at a tick.
mod layout;
mod sea_waves;

fn main() {
    let sea = sea_waves::SeaWaves::open(&std::env::args().nth(1).unwrap(), usize::MAX).unwrap();
    let made = layout::Layout::new(&sea).unwrap();
    for (name, numbers) in [("h0", &made.h0), ("wave", &made.wave), ("twiddle", &made.twiddle)] {
        std::fs::write(name, layout::bytes_of(numbers)).unwrap();
    }
    std::fs::write("block", made.block(12345, 0.9)).unwrap();
    println!("{} {} {} {}", made.texels, made.map_texels, made.groups, made.longest);
}
