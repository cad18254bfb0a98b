//! SPIR-V as words: taking modules apart and making instructions.

/// Opcodes (SPIR-V, Instructions).
pub(crate) const EXTENSION: u32 = 10;
pub(crate) const ENTRY_POINT: u32 = 15;
pub(crate) const EXECUTION_MODE: u32 = 16;
pub(crate) const CAPABILITY: u32 = 17;
pub(crate) const TYPE_INT: u32 = 21;
pub(crate) const TYPE_VECTOR: u32 = 23;
pub(crate) const TYPE_IMAGE: u32 = 25;
pub(crate) const TYPE_ARRAY: u32 = 28;
pub(crate) const TYPE_POINTER: u32 = 32;
pub(crate) const CONSTANT: u32 = 43;
pub(crate) const CONSTANT_NULL: u32 = 46;
pub(crate) const FUNCTION: u32 = 54;
pub(crate) const FUNCTION_END: u32 = 56;
pub(crate) const VARIABLE: u32 = 59;
pub(crate) const LOAD: u32 = 61;
pub(crate) const STORE: u32 = 62;
pub(crate) const ACCESS_CHAIN: u32 = 65;
pub(crate) const DECORATE: u32 = 71;
pub(crate) const IMAGE_FETCH: u32 = 95;
pub(crate) const IMAGE_READ: u32 = 98;
pub(crate) const RETURN: u32 = 253;

/// The decoration Location.
pub(crate) const LOCATION: u32 = 30;
/// The decoration Binding.
pub(crate) const BINDING: u32 = 33;
/// The decoration BuiltIn.
pub(crate) const BUILT_IN: u32 = 11;
/// The storage class Input.
#[cfg(test)]
pub(crate) const INPUT: u32 = 1;
/// The storage class Output.
pub(crate) const OUTPUT: u32 = 3;

/// Returns an instruction.
pub(crate) fn instruction(opcode: u32, operands: &[u32]) -> Vec<u32> {
    let mut words = vec![((operands.len() as u32 + 1) << 16) | opcode];
    words.extend(operands);
    words
}

/// Returns the header and the instructions of a module.
pub(crate) fn instructions(words: &[u32]) -> (&[u32], Vec<&[u32]>) {
    let (header, mut rest) = words.split_at(5);
    let mut instructions = Vec::new();
    while let [head, ..] = rest {
        let (instruction, behind) = rest.split_at((head >> 16).max(1) as usize);
        instructions.push(instruction);
        rest = behind;
    }
    (header, instructions)
}

/// Returns the instruction that declares an extension.
pub(crate) fn extension(name: &str) -> Vec<u32> {
    let mut bytes = name.as_bytes().to_vec();
    bytes.resize(bytes.len() / 4 * 4 + 4, 0);
    let words = bytes
        .chunks_exact(4)
        .map(|c| u32::from_le_bytes([c[0], c[1], c[2], c[3]]));
    instruction(EXTENSION, &words.collect::<Vec<_>>())
}

/// Returns the module with another capability and its extension declared.
pub(crate) fn with_capability(words: &[u32], capability: u32, name: &str) -> Vec<u32> {
    let (header, instructions) = instructions(words);
    let is_capability = |instruction: &&[u32]| instruction[0] & 0xffff == CAPABILITY;
    let behind = instructions
        .iter()
        .take_while(|instruction| is_capability(instruction))
        .count();
    let (capabilities, rest) = instructions.split_at(behind);
    let mut out = header.to_vec();
    out.extend(instruction(CAPABILITY, &[capability]));
    out.extend(capabilities.concat());
    out.extend(extension(name));
    out.extend(rest.concat());
    out
}
