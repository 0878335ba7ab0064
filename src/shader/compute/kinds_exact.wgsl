let faint = false;
    let kind = 0u;
